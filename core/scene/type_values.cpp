#include "scene/type_values.hpp"

#include "scene/coordinate_reader.hpp"
#include "scene/frame_reader.hpp"

namespace koppel {
namespace {

bool is_about_the_type(Code code) {
  return code == Code::unknown_type || code == Code::plugin_without_type || code == Code::type_taken;
}

/// Reads one parameter; `given` and the frames and coordinates follow from the kind.
class ParameterReader {
 public:
  ParameterReader(Reading& reading, Scope& scope, const ValueReader& values, const Matrix3& to_inlet,
                  std::string_view value_unit, std::string_view column_unit, TypeValues& out)
      : reading_(reading),
        scope_(scope),
        values_(values),
        to_inlet_(to_inlet),
        value_unit_(value_unit),
        column_unit_(column_unit),
        out_(out) {}

  Value read(const Parameter& parameter, const Node& node) {
    Value value;
    value.given = true;
    const std::string what = quote(parameter.name);
    switch (parameter.kind) {
      case ParameterKind::real: take(value, read_reals(parameter, node, what)); break;
      case ParameterKind::integer: take(value, read_integers(parameter, node, what)); break;
      case ParameterKind::boolean: take(value, read_boolean(node, what)); break;
      case ParameterKind::string: read_text(value, node, what); break;
      case ParameterKind::vector: take(value, values_.numbers(node, what, 3, 3, parameter.unit)); break;
      case ParameterKind::direction: read_direction(value, node, what); break;
      case ParameterKind::table: take(value, read_table(parameter, node, what)); break;
      case ParameterKind::frame: read_frame_value(value, node, what); break;
      case ParameterKind::coordinates: read_coordinates(value, parameter, node, what); break;
    }
    check_range(parameter, node, value, what);
    return value;
  }

 private:
  using Numbers = std::optional<std::vector<double>>;

  static void take(Value& value, Numbers numbers) {
    if (!numbers) return;
    value.numbers = std::move(*numbers);
    value.count = value.numbers.size();
  }

  std::string_view unit_of_reals(const Parameter& parameter) const {
    return parameter.unit.empty() ? value_unit_ : parameter.unit;
  }

  Numbers read_reals(const Parameter& parameter, const Node& node, const std::string& what) const {
    if (parameter.count_max > 1 && (node.is_list() || parameter.count_min > 1)) {
      return values_.numbers(node, what, parameter.count_min, parameter.count_max, unit_of_reals(parameter));
    }
    const auto number = values_.number(node, what, unit_of_reals(parameter));
    return number ? Numbers(std::vector<double>{*number}) : std::nullopt;
  }

  Numbers read_integers(const Parameter& parameter, const Node& node, const std::string& what) const {
    Numbers numbers = read_reals(parameter, node, what);
    if (!numbers) return std::nullopt;
    for (const double number : *numbers) {
      if (!values_.is_whole(number, node, what)) return std::nullopt;
    }
    return numbers;
  }

  Numbers read_boolean(const Node& node, const std::string& what) const {
    if (node.kind == Node::Kind::boolean) return std::vector<double>{node.truth ? 1.0 : 0.0};
    values_.wrong_kind(node, what, "true or false");
    return std::nullopt;
  }

  void read_text(Value& value, const Node& node, const std::string& what) const {
    const auto text = values_.text(node, what);
    if (!text) return;
    value.text = *text;
    value.count = 1;
  }

  void read_direction(Value& value, const Node& node, const std::string& what) const {
    const auto direction = values_.direction(node, what);
    if (!direction) return;
    const Vector3 turned = (to_inlet_ * *direction).normalized();
    take(value, std::vector<double>{turned.x(), turned.y(), turned.z()});
  }

  Numbers read_table(const Parameter& parameter, const Node& node, const std::string& what) const {
    if (!values_.is_list(node, what, parameter.count_min, parameter.count_max)) return std::nullopt;
    std::vector<double> numbers;
    bool complete = true;
    for (const Node& row : node.items) {
      const std::string row_name = "a row of " + what;
      if (!values_.is_list(row, row_name, parameter.columns, parameter.columns)) {
        complete = false;
        continue;
      }
      for (std::size_t i = 0; i < row.items.size(); ++i) {
        const auto number = values_.number(row.items[i], row_name, i == 0 ? parameter.unit : column_unit_);
        complete = complete && number;
        numbers.push_back(number.value_or(0.0));
      }
    }
    return complete ? Numbers(std::move(numbers)) : std::nullopt;
  }

  void read_frame_value(Value& value, const Node& node, const std::string& what) const {
    const auto attachment = read_attachment(reading_, scope_, values_, node, what);
    if (!attachment) return;
    out_.frames.push_back(*attachment);
    value.count = 1;
  }

  void read_coordinates(Value& value, const Parameter& parameter, const Node& node, const std::string& what) const {
    const bool single = node.is_string() && parameter.count_min <= 1;
    if (!single && !values_.is_list(node, what, parameter.count_min, parameter.count_max)) return;
    const std::size_t count = single ? 1 : node.items.size();
    for (std::size_t i = 0; i < count; ++i) {
      const Node& item = single ? node : node.items[i];
      const auto coordinate = read_scalar_coordinate(reading_, scope_, values_, item, what);
      if (coordinate) out_.coordinates.push_back(*coordinate);
    }
    value.count = count;
  }

  void check_range(const Parameter& parameter, const Node& node, const Value& value, const std::string& what) const {
    const std::string unit = parameter.unit.empty() ? "" : ' ' + parameter.unit;
    for (const double number : value.numbers) {
      const bool low = parameter.minimum && number < *parameter.minimum;
      const bool high = parameter.maximum && number > *parameter.maximum;
      if (!low && !high) continue;
      const double bound = low ? *parameter.minimum : *parameter.maximum;
      std::string message = what;
      message.append(low ? " must be at least " : " must be at most ").append(number_text(bound)).append(unit);
      message.append(", and is ").append(number_text(number)).append(unit);
      values_.report().error(Code::out_of_range, node.place, message, parameter.doc);
      return;
    }
  }

  Reading& reading_;
  Scope& scope_;
  const ValueReader& values_;
  const Matrix3& to_inlet_;
  std::string_view value_unit_, column_unit_;
  TypeValues& out_;
};

}  // namespace

template <typename T>
const T* find_type(Reading& reading, const Scope& scope, TableReader& table, std::string_view standard,
                   Result<const T*> (Registry::*find)(std::string_view, const PluginReference&)) {
  const Node* type = standard.empty() ? table.require("type", "name the type: type = \"...\"") : table.find("type");
  const Node* plugin = table.find("plugin");
  const auto name = type ? table.values().text(*type, "`type`") : std::optional<std::string>(standard);
  const auto file = plugin ? table.values().text(*plugin, "`plugin`") : std::optional<std::string>("");
  if (!name || name->empty() || !file) {
    if (type != nullptr && name && name->empty()) {
      table.report().error(Code::unknown_type, type->place, "`type` is empty", "name the type");
    }
    return nullptr;
  }
  auto found = (reading.registry.*find)(*name, {*file, scope.folder});
  if (found) return *found;
  Error error = std::move(found).error();
  const bool of_type = is_about_the_type(error.code);
  // A plugin that cannot be loaded is one fault, however many elements need it.
  if (!of_type && !reading.faulty_plugins.insert(scope.folder.string() + '\n' + *file + '\n' + *name).second) {
    return nullptr;
  }
  const Node* place = plugin != nullptr && !of_type ? plugin : type;
  table.report().error(std::move(error), place != nullptr ? place->place : table.place());
  return nullptr;
}

template const JointType* find_type(Reading&, const Scope&, TableReader&, std::string_view,
                                    Result<const JointType*> (Registry::*)(std::string_view, const PluginReference&));
template const BodyType* find_type(Reading&, const Scope&, TableReader&, std::string_view,
                                   Result<const BodyType*> (Registry::*)(std::string_view, const PluginReference&));
template const ConstraintType* find_type(Reading&, const Scope&, TableReader&, std::string_view,
                                         Result<const ConstraintType*> (Registry::*)(std::string_view,
                                                                                     const PluginReference&));
template const FunctionType* find_type(Reading&, const Scope&, TableReader&, std::string_view,
                                       Result<const FunctionType*> (Registry::*)(std::string_view,
                                                                                 const PluginReference&));
template const ForceType* find_type(Reading&, const Scope&, TableReader&, std::string_view,
                                    Result<const ForceType*> (Registry::*)(std::string_view, const PluginReference&));

Value fallback_value(const Parameter& parameter) {
  Value value;
  value.numbers = parameter.fallback.value_or(std::vector<double>{});
  value.count = value.numbers.size();
  return value;
}

TypeValues read_values(Reading& reading, Scope& scope, TableReader& table, const Type& type, const Matrix3& to_inlet,
                       std::string_view value_unit) {
  TypeValues out;
  // The columns of a function's table are its values; those of a force's table are forces, whatever it acts on.
  const std::string_view column_unit = type.kind == PluginKind::function ? value_unit : std::string_view();
  ParameterReader reader(reading, scope, table.values(), to_inlet, value_unit, column_unit, out);
  for (const Parameter& parameter : type.parameters) {
    Value value;
    if (const Node* node = table.find(parameter.name)) {
      value = reader.read(parameter, *node);
    } else if (parameter.required) {
      std::string advice = parameter.doc;
      if (!parameter.unit.empty()) advice += " [" + parameter.unit + ']';
      table.report().error(Code::missing_key, table.place(), quote(parameter.name) + " is missing", advice);
    } else {
      value = fallback_value(parameter);
    }
    out.values.push_back(std::move(value));
  }
  return out;
}

}  // namespace koppel
