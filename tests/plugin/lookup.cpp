// Where a type is looked for, and what is said when it is not there.
#include <filesystem>

#include "fixtures.hpp"
#include "folders.hpp"

namespace koppel::test {
namespace {

namespace fs = std::filesystem;

/// A folder of its own, gone after the test; the test runs with it as working directory.
class Lookup : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder = fs::temp_directory_path() / (std::string("koppel_lookup_") + test->name());
    fs::remove_all(folder);
    fs::create_directories(folder / "scene" / "parts");
    fs::create_directories(folder / "path");
    folder = fs::canonical(folder);
    before = fs::current_path();
    fs::current_path(folder);
  }
  void TearDown() override {
    fs::current_path(before);
    fs::remove_all(folder);
  }
  void put(const fs::path& where) const { fs::copy_file(fs::path(test_plugins_folder()) / "acme.so", folder / where); }

  static Result<const JointType*> hinge(Registry& registry, const std::string& file, const fs::path& scene_folder) {
    return registry.joint("acme.hinge", {file, scene_folder});
  }

  fs::path folder, before;
};

TEST_F(Lookup, FindsAFileBesideTheScene) {
  put("scene/parts/acme.so");
  Registry registry(linked_in());
  const JointType* type = expect_value(hinge(registry, "parts/acme.so", folder / "scene"));
  EXPECT_EQ(type->origin, (folder / "scene/parts/acme.so").string());
}

TEST_F(Lookup, FindsAFileOnThePluginPath) {
  put("path/acme.so");
  RegistryOptions options = linked_in();
  options.plugin_path = {folder / "nowhere", folder / "path"};
  Registry registry(std::move(options));
  EXPECT_TRUE(hinge(registry, "acme.so", folder / "scene"));
}

TEST_F(Lookup, FindsTheVendorsFileWithoutBeingTold) {
  put("path/acme.so");
  RegistryOptions options = linked_in();
  options.plugin_path = {folder / "path"};
  Registry registry(std::move(options));
  EXPECT_TRUE(hinge(registry, "", {}));
}

TEST_F(Lookup, NeverTakesAFileFromTheWorkingDirectory) {
  put("acme.so");
  RegistryOptions options = linked_in();
  options.plugin_path = {""};
  Registry registry(std::move(options));
  for (const char* file : {"acme.so", ""}) {
    const auto type = hinge(registry, file, {});
    ASSERT_FALSE(type);
    EXPECT_EQ(type.error().code, Code::plugin_not_found);
    expect_mentions(type.error(), {"acme.hinge", "acme.so", "KOPPEL_PLUGIN_PATH"});
  }
}

TEST_F(Lookup, TakesAbsoluteNamesAsTheyAre) {
  put("acme.so");
  Registry registry(linked_in());
  EXPECT_TRUE(hinge(registry, (folder / "acme.so").string(), {}));
  const auto missing = registry.joint("other.hinge", {(folder / "other.so").string(), {}});
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, Code::plugin_not_found);
}

TEST_F(Lookup, KnowsAFileAgainByWhateverName) {
  put("scene/acme.so");
  fs::create_symlink(folder / "scene/acme.so", folder / "path/link.so");
  RegistryOptions options = linked_in();
  options.plugin_path = {folder / "path"};
  Registry registry(std::move(options));
  const JointType* type = expect_value(hinge(registry, "acme.so", folder / "scene"));
  EXPECT_EQ(expect_value(hinge(registry, "parts/../acme.so", folder / "scene")), type);
  EXPECT_EQ(expect_value(hinge(registry, "link.so", {})), type);
  EXPECT_TRUE(registry.load(folder / "path/link.so"));
}

TEST_F(Lookup, NeverTakesATypeFromAnotherFileThanTheSceneNames) {
  put("scene/acme.so");
  put("path/acme.so");
  RegistryOptions options = linked_in();
  options.plugin_path = {folder / "path"};
  Registry registry(std::move(options));
  ASSERT_TRUE(hinge(registry, "acme.so", folder / "scene"));
  const auto other = hinge(registry, "acme.so", {});
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, Code::type_taken);
  expect_mentions(other.error(), {"acme.hinge", "scene/acme.so", "path/acme.so"});
}

struct Misnamed {
  std::string name;
  Code code;
  std::vector<std::string> mentioned;
};

TEST(Names, AreExplainedWhereTheyAreWrong) {
  Registry registry(with_strangers());
  for (const Misnamed& wrong :
       std::vector<Misnamed>{{"revolut", Code::unknown_type, {"joint", "`revolut`", "did you mean `revolute`?"}},
                             {"hovercraft", Code::unknown_type, {"there are revolute, prismatic"}},
                             {"rigid", Code::unknown_type, {"`rigid` is a body type, not a joint type"}},
                             {"acme.hnge", Code::plugin_without_type, {"acme.so", "did you mean `acme.hinge`?"}},
                             {"nobody.hinge", Code::plugin_not_found, {"`nobody.hinge`", "nobody.so"}},
                             {"../acme.hinge", Code::unknown_type, {"no name of a type"}},
                             {"acme/x.hinge", Code::unknown_type, {"no name of a type"}},
                             {"acme.", Code::unknown_type, {"no name of a type"}},
                             {"", Code::unknown_type, {"no name of a type"}}}) {
    const auto type = registry.joint(wrong.name, {});
    ASSERT_FALSE(type) << wrong.name;
    EXPECT_EQ(type.error().code, wrong.code) << render(type.error());
    expect_mentions(type.error(), wrong.mentioned);
  }
}

TEST(Names, AreCorrectedTheSameWithSharedObjects) {
  Registry registry(as_shared_objects());
  const auto type = registry.joint("revolut", {});
  ASSERT_FALSE(type);
  expect_mentions(type.error(), {"did you mean `revolute`?"});
}

TEST(Names, OfStandardTypesComeFromNoFile) {
  Registry registry(with_strangers());
  const auto standard = registry.joint("revolute", {"acme.so", {}});
  ASSERT_FALSE(standard);
  EXPECT_EQ(standard.error().code, Code::conflicting_keys);
  const auto plain = registry.joint("hinge", {"acme.so", {}});
  ASSERT_FALSE(plain);
  expect_mentions(plain.error(), {"vendor.type"});
}

TEST(Names, OfLinkedInPluginsAreProposed) {
  Registry registry(linked_in());
  ASSERT_TRUE(registry.load(test_plugins_folder() + "/acme.so"));
  const auto type = registry.joint("acme.hnge", {});
  ASSERT_FALSE(type);
  EXPECT_EQ(type.error().code, Code::plugin_without_type);
  expect_mentions(type.error(), {"did you mean `acme.hinge`?"});
}

}  // namespace
}  // namespace koppel::test
