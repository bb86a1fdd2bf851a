// [[body]] and [[frame]].
#include "scene/frame_reader.hpp"
#include "scene/type_values.hpp"

namespace koppel {

void read_body(Reading& reading, const Element& element) {
  Scope& scope = *element.scope;
  TableReader table = reading.table(element);
  table.find("name");
  BodyDescription& body = reading.scene.bodies[element.index];
  table.at_most_one({"rotate", "quaternion"});
  if (const auto design = read_pose(table)) body.design = *design;
  body.type = find_type<BodyType>(reading, scope, table, "rigid", &Registry::body);
  if (body.type == nullptr) return table.finish_without_type();
  body.values = read_values(reading, scope, table, *body.type).values;
  table.finish();
}

void read_frame(Reading& reading, const Element& element) {
  TableReader table = reading.table(element);
  table.find("name");
  if (const auto on = read_attachment(reading, *element.scope, table)) {
    reading.scene.frames[element.index].on = *on;
  } else {
    reading.faulty_frames.insert(static_cast<std::uint32_t>(element.index));
  }
  table.finish();
}

}  // namespace koppel
