// Scenes that take in other scenes.
#include <cstdlib>
#include <fstream>

#include "scene_reader.hpp"

namespace koppel {
namespace {

namespace fs = std::filesystem;

/// A folder with files, removed at the end.
class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "koppel-include-XXXXXX").string();
    EXPECT_NE(mkdtemp(name.data()), nullptr);
    path = fs::path(name);
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((path / name).parent_path());
    std::ofstream(path / name) << text;
  }

  fs::path path;
};

const std::string side =
    "schema = 1\n"
    "[scene]\nname = 'not-used'\ngravity = [0, 0, 0]\n"
    "[parameters]\nside = 1\ntrack = 1.5\nhalf = 'side*track/2'\n"
    "[[body]]\nname = 'carrier'\nat = [0, 'half', 0]\n"
    "[[frame]]\nname = 'wheel'\non = 'carrier'\nat = [0, '0.1*side', 0]\n"
    "[[joint]]\nname = 'strut'\ntype = 'prismatic'\nbetween = ['ground', 'carrier']\n"
    "[[force]]\nname = 'hold'\ntype = 'spring'\nfrom = 'ground'\nto = 'wheel'\n"
    "[[force]]\nname = 'push'\ntype = 'motor'\nof = 'strut.displacement'\n"
    "[simulation]\nstep = 0.25\n";

TEST(Include, gives_names_a_prefix_and_sets_parameters) {
  Folder folder;
  folder.write("parts/side.toml", side);
  folder.write(
      "car.toml",
      "schema = 1\n[parameters]\nwidth = 2\n"
      "[[include]]\nfile = 'parts/side.toml'\nprefix = 'left'\n"
      "[[include]]\nfile = 'parts/side.toml'\nprefix = 'right'\nparameters = { side = -1, track = '2*width' }\n"
      "[[drive]]\nof = 'left.strut.displacement'\ntype = 'constant'\nvalue = 0\n"
      "[[joint]]\nname = 'axle'\ntype = 'distance-free'\ninlet = 'left.wheel'\noutlet = 'right.wheel'\n");
  SceneReader reader;
  ASSERT_FALSE(reader.read_file(folder.path / "car.toml"));  // the joint's type does not exist
  ASSERT_EQ(reader.of(Severity::error).size(), 1u) << reader.diagnostics.render();

  folder.write(
      "car.toml",
      "schema = 1\n[parameters]\nwidth = 2\n"
      "[[include]]\nfile = 'parts/side.toml'\nprefix = 'left'\n"
      "[[include]]\nfile = 'parts/side.toml'\nprefix = 'right'\nparameters = { side = -1, track = '2*width' }\n"
      "[[drive]]\nof = 'left.strut.displacement'\ntype = 'constant'\nvalue = 0\n"
      "[[joint]]\nname = 'axle'\ntype = 'free'\ninlet = 'left.wheel'\noutlet = 'right.wheel'\n");
  const auto scene = reader.read_file(folder.path / "car.toml");
  ASSERT_TRUE(scene.has_value()) << reader.diagnostics.render();
  EXPECT_TRUE(reader.diagnostics.findings().empty()) << reader.diagnostics.render();
  EXPECT_EQ(scene->name, "scene");
  EXPECT_EQ(scene->gravity, Vector3(0, 0, -9.81));
  ASSERT_EQ(scene->bodies.size(), 3u);
  EXPECT_EQ(scene->bodies[1].name, "left.carrier");
  EXPECT_EQ(scene->bodies[1].design.position, Vector3(0, 0.75, 0));
  EXPECT_EQ(scene->bodies[2].name, "right.carrier");
  EXPECT_EQ(scene->bodies[2].design.position, Vector3(0, -2, 0));
  EXPECT_FALSE(scene->simulation.step.has_value());
  ASSERT_EQ(scene->forces.size(), 4u);
  EXPECT_EQ(scene->forces[0].name, "left.hold");
  EXPECT_EQ(scene->forces[2].frames[1].body, BodyId{2});
  EXPECT_EQ(scene->forces[3].name, "right.push");
  EXPECT_EQ(scene->forces[3].coordinates[0].joint, JointId{2});
  ASSERT_EQ(scene->joints.size(), 3u);
  EXPECT_EQ(scene->joints[0].name, "axle");
  EXPECT_EQ(scene->joints[0].outlet.pose.position, Vector3(0, -0.1, 0));
  EXPECT_EQ(scene->joints[1].name, "left.strut");
  EXPECT_EQ(scene->joints[1].inlet.body, ground);
  EXPECT_EQ(scene->drives.at(0).name, "left.strut.displacement");
  EXPECT_EQ(scene->drives.at(0).of.joint, JointId{1});
}

TEST(Include, nests) {
  Folder folder;
  folder.write("side.toml", side);
  folder.write("axle.toml", "schema = 1\n[[include]]\nfile = 'side.toml'\nprefix = 'left'\n");
  SceneReader reader;
  const Scene scene = reader.good("schema = 1\n[[include]]\nfile = 'axle.toml'\nprefix = 'front'\n", folder.path);
  EXPECT_EQ(scene.bodies.at(1).name, "front.left.carrier");
}

TEST(Include, reports_faults_in_the_file_that_has_them_and_once) {
  Folder folder;
  folder.write("side.toml", "schema = 1\n[[body]]\nname = 'a'\nmas = 3\n");
  SceneReader reader;
  ASSERT_FALSE(reader.read(
      "schema = 1\n[[include]]\nfile = 'side.toml'\nprefix = 'l'\n[[include]]\nfile = 'side.toml'\nprefix = 'r'\n",
      folder.path));
  const auto errors = reader.of(Severity::error);
  ASSERT_EQ(errors.size(), 1u) << reader.diagnostics.render();
  EXPECT_EQ(errors[0].source.file, "side.toml");
  EXPECT_EQ(errors[0].source.line, 4);
  EXPECT_EQ(errors[0].element, "body l.a");
}

TEST(Include, that_fails_is_the_only_fault) {
  Folder folder;
  folder.write("broken.toml", "schema = 1\n[[body]\n");
  const std::string rest =
      "prefix = 'l'\n[[joint]]\nname = 'j'\ntype = 'weld'\ninlet = 'ground'\noutlet = 'l.hub'\n"
      "[[drive]]\nof = 'l.strut.displacement'\ntype = 'constant'\nvalue = 0\n";
  SceneReader reader;
  ASSERT_FALSE(reader.read("schema = 1\n[[include]]\nfile = 'broken.toml'\n" + rest, folder.path));
  ASSERT_EQ(reader.of(Severity::error).size(), 1u) << reader.diagnostics.render();
  EXPECT_EQ(reader.diagnostics.first_error().code, Code::toml_syntax);
  EXPECT_EQ(reader.diagnostics.first_error().source.file, "broken.toml");

  ASSERT_FALSE(reader.read("schema = 1\n[[include]]\nfile = 'missing.toml'\n" + rest, folder.path));
  ASSERT_EQ(reader.of(Severity::error).size(), 1u) << reader.diagnostics.render();
  EXPECT_EQ(reader.diagnostics.first_error().code, Code::file_unreadable);
  EXPECT_EQ(reader.diagnostics.first_error().source.line, 3);
}

TEST(Include, finds_circles_through_links) {
  Folder folder;
  folder.write("a.toml", "schema = 1\n[[include]]\nfile = 'b.toml'\nprefix = 'b'\n");
  folder.write("b.toml", "schema = 1\n[[include]]\nfile = 'link.toml'\nprefix = 'a'\n");
  fs::create_symlink(folder.path / "a.toml", folder.path / "link.toml");
  SceneReader reader;
  ASSERT_FALSE(reader.read_file(folder.path / "a.toml"));
  ASSERT_EQ(reader.of(Severity::error).size(), 1u) << reader.diagnostics.render();
  EXPECT_EQ(reader.diagnostics.first_error().code, Code::include_cycle);
}

TEST(Include, does_not_grow_without_bounds) {
  Folder folder;
  for (int i = 0; i < 40; ++i) {
    const std::string next = std::to_string(i + 1) + ".toml";
    folder.write(std::to_string(i) + ".toml", "schema = 1\n[[include]]\nfile = '" + next +
                                                  "'\nprefix = 'l'\n[[include]]\nfile = '" + next +
                                                  "'\nprefix = 'r'\n");
  }
  folder.write("40.toml", "schema = 1\n");
  SceneReader reader;
  ASSERT_FALSE(reader.read_file(folder.path / "0.toml"));
  EXPECT_EQ(reader.diagnostics.first_error().code, Code::out_of_range);
}

TEST(Include, refuses_parameters_that_the_scene_does_not_have) {
  Folder folder;
  folder.write("side.toml", side);
  SceneReader reader;
  ASSERT_FALSE(reader.read("schema = 1\n[[include]]\nfile = 'side.toml'\nprefix = 'l'\nparameters = { sid = -1 }\n",
                           folder.path));
  ASSERT_EQ(reader.of(Severity::error).size(), 1u) << reader.diagnostics.render();
  EXPECT_EQ(reader.diagnostics.first_error().code, Code::unknown_parameter);
  EXPECT_EQ(reader.diagnostics.first_error().advice, "did you mean `side`?");
  EXPECT_EQ(marked(reader.diagnostics.first_error()), "sid");
}

TEST(Include, refuses_a_bad_prefix) {
  Folder folder;
  folder.write("side.toml", side);
  SceneReader reader;
  ASSERT_FALSE(reader.read("schema = 1\n[[include]]\nfile = 'side.toml'\nprefix = 'l.'\n", folder.path));
  EXPECT_EQ(reader.diagnostics.first_error().code, Code::bad_name);
}

TEST(Include, has_a_prefix_of_its_own) {
  Folder folder;
  folder.write("side.toml", side);
  folder.write("other.toml", "schema = 1\n[[body]]\nname = 'hub'\n");
  for (const std::string second : {"side.toml", "other.toml"}) {
    SceneReader reader;
    ASSERT_FALSE(reader.read("schema = 1\n[[include]]\nfile = 'side.toml'\nprefix = 'left'\n[[include]]\nfile = '" +
                                 second + "'\nprefix = 'left'\n[[record]]\nof = 'left.hub'\n",
                             folder.path));
    ASSERT_EQ(reader.of(Severity::error).size(), 1u) << reader.diagnostics.render();
    const Error& error = reader.diagnostics.first_error();
    EXPECT_EQ(error.code, Code::duplicate_name);
    EXPECT_EQ(error.message, "prefix `left` is taken");
    EXPECT_EQ(error.source.line, 7);
    EXPECT_EQ(marked(error), "'left'");
  }
}

TEST(Include, is_remembered_where_the_prefix_is_forgotten) {
  Folder folder;
  folder.write("side.toml", side);
  const std::string car = "schema = 1\n[[include]]\nfile = 'side.toml'\nprefix = 'left'\n";
  SceneReader reader;
  ASSERT_FALSE(reader.read(car + "[[record]]\nof = 'wheel'\n", folder.path));
  EXPECT_EQ(reader.diagnostics.first_error().advice, "did you mean `left.wheel`?");
  ASSERT_FALSE(reader.read(car + "[[record]]\nof = 'strut.displacement'\n", folder.path));
  EXPECT_EQ(reader.diagnostics.first_error().advice, "did you mean `left.strut`?");
}

TEST(Include, sees_only_names_of_its_own_file) {
  Folder folder;
  folder.write("part.toml", "schema = 1\n[[frame]]\nname = 'f'\non = 'outer'\n");
  SceneReader reader;
  ASSERT_FALSE(reader.read("schema = 1\n[[body]]\nname = 'outer'\n[[include]]\nfile = 'part.toml'\nprefix = 'p'\n",
                           folder.path));
  EXPECT_EQ(reader.diagnostics.first_error().code, Code::unknown_body);
}

}  // namespace
}  // namespace koppel
