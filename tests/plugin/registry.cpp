// Loading: standard types in both forms, laziness, life times, values as they reach a plugin.
#include <array>
#include <cstring>
#include <memory>

#include <spdlog/logger.h>
#include <spdlog/sinks/ostream_sink.h>

#include "fixtures.hpp"
#include "folders.hpp"

namespace koppel::test {
namespace {

constexpr std::array kinds = {PluginKind::joint, PluginKind::body, PluginKind::constraint, PluginKind::function,
                              PluginKind::force};

const Type* find(Registry& registry, PluginKind kind, const std::string& name) {
  switch (kind) {
    case PluginKind::joint: return expect_value(registry.joint(name, {}));
    case PluginKind::body: return expect_value(registry.body(name, {}));
    case PluginKind::constraint: return expect_value(registry.constraint(name, {}));
    case PluginKind::function: return expect_value(registry.function(name, {}));
    case PluginKind::force: return expect_value(registry.force(name, {}));
  }
  return nullptr;
}

void expect_same_schema(const Type& a, const Type& b) {
  SCOPED_TRACE(a.name);
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.summary, b.summary);
  EXPECT_FALSE(a.summary.empty());
  ASSERT_EQ(a.parameters.size(), b.parameters.size());
  for (std::size_t i = 0; i < a.parameters.size(); ++i) {
    const Parameter &p = a.parameters[i], &q = b.parameters[i];
    EXPECT_EQ(p.kind, q.kind);
    EXPECT_EQ(p.name, q.name);
    EXPECT_EQ(p.unit, q.unit);
    EXPECT_EQ(p.doc, q.doc);
    EXPECT_FALSE(p.doc.empty());
    EXPECT_EQ(p.required, q.required);
    EXPECT_EQ(p.columns, q.columns);
    EXPECT_EQ(p.count_min, q.count_min);
    EXPECT_EQ(p.count_max, q.count_max);
    EXPECT_EQ(p.fallback, q.fallback);
    EXPECT_EQ(p.minimum, q.minimum);
    EXPECT_EQ(p.maximum, q.maximum);
  }
}

TEST(StandardTypes, AreAllThere) {
  Registry registry(linked_in());
  EXPECT_EQ(registry.names(PluginKind::joint),
            (std::vector<std::string>{"revolute", "prismatic", "helical", "cylindrical", "universal", "spherical",
                                      "planar", "free", "weld"}));
  EXPECT_EQ(registry.names(PluginKind::body), (std::vector<std::string>{"rigid", "point_mass"}));
  EXPECT_EQ(registry.names(PluginKind::constraint), (std::vector<std::string>{"distance", "coupling"}));
  EXPECT_EQ(registry.names(PluginKind::function),
            (std::vector<std::string>{"constant", "ramp", "sine", "polynomial", "table", "cycloid"}));
  EXPECT_EQ(registry.names(PluginKind::force),
            (std::vector<std::string>{"spring", "coordinate_spring", "stop", "bushing", "motor", "controller", "wrench",
                                      "friction"}));
}

TEST(StandardTypes, AreTheSameAsSharedObjects) {
  Registry built_in(linked_in()), loaded(as_shared_objects());
  for (const PluginKind kind : kinds) {
    const auto names = built_in.names(kind);
    EXPECT_EQ(loaded.names(kind).size(), names.size());
    for (const std::string& name : names) {
      const Type *here = find(built_in, kind, name), *there = find(loaded, kind, name);
      expect_same_schema(*here, *there);
      EXPECT_EQ(here->origin, "built in");
      EXPECT_EQ(there->origin, standard_plugins_folder() + "/" + name + ".so");
    }
  }
}

TEST(StandardTypes, TakeTablesOfAnyLength) {
  Registry registry(linked_in());
  const Parameter& points = expect_value(registry.function("table", {}))->parameters.front();
  EXPECT_EQ(points.columns, 2u);
  EXPECT_EQ(points.count_min, 2u);
  EXPECT_GT(points.count_max, 1000000u);
}

// ---- a plugin that keeps a diary

struct Diary {
  int inits = 0, deinits = 0, instances = 0;
  koppel_version host{};
  std::vector<koppel_value> values;
  std::vector<double> numbers;
  std::string text;
};
Diary diary;  // plugins have no other place to leave notes for a test

koppel_status diary_init(const koppel_host* host) {
  ++diary.inits;
  diary.host = host->version;
  host->log(host->context, KOPPEL_LOG_WARNING, "dear diary");
  return KOPPEL_OK;
}
void diary_deinit() { ++diary.deinits; }

koppel_status diary_create(const koppel_host*, const koppel_value* values, void** instance) {
  ++diary.instances;
  diary.values.assign(values, values + 4);
  diary.numbers.assign(values[0].reals, values[0].reals + values[0].count);
  if (values[1].text != nullptr) diary.text = values[1].text;
  *instance = &diary;
  return KOPPEL_OK;
}
void diary_destroy(void*) { --diary.instances; }

koppel_status nothing(size_t, const void* const*, const double*, double*) { return KOPPEL_OK; }

constexpr koppel_parameter parameter(const char* name, int32_t kind) {
  koppel_parameter p{};
  p.struct_size = sizeof p;
  p.name = name;
  p.kind = kind;
  return p;
}
constexpr koppel_parameter parameters[] = {
    parameter("vector", KOPPEL_PARAMETER_VECTOR), parameter("string", KOPPEL_PARAMETER_STRING),
    parameter("absent", KOPPEL_PARAMETER_REAL), parameter("flag", KOPPEL_PARAMETER_BOOLEAN)};

/// Two functions, called after `vendor`.
template <const char* first, const char* second>
const void* two_functions(const char* interface_id, size_t index) {
  static constexpr koppel_type types[] = {{sizeof(koppel_type), first, "", parameters, 4, diary_create, diary_destroy},
                                          {sizeof(koppel_type), second, "", nullptr, 0, nullptr, nullptr}};
  static constexpr koppel_function_type tables[] = {{sizeof(koppel_function_type), &types[0], nothing},
                                                    {sizeof(koppel_function_type), &types[1], nothing}};
  if (std::strcmp(interface_id, KOPPEL_FUNCTION_INTERFACE) != 0 || index > 1) return nullptr;
  return &tables[index];
}

constexpr char diary_one[] = "diary.one", diary_two[] = "diary.two", plain_one[] = "one", plain_two[] = "two";
using TypeTable = const void* (*)(const char*, size_t);
koppel_plugin_entry entry_of(TypeTable table, uint32_t minor = KOPPEL_ABI_MINOR) {
  return {sizeof(koppel_plugin_entry), {KOPPEL_ABI_MAJOR, minor, 0}, "diary", diary_init, diary_deinit, table};
}
const koppel_plugin_entry diary_entry = entry_of(two_functions<diary_one, diary_two>);
const koppel_plugin_entry plain_entry = entry_of(two_functions<plain_one, plain_two>);

class WithDiary : public testing::Test {
 protected:
  void SetUp() override { diary = {}; }
};

using Loading = WithDiary;

TEST_F(Loading, WaitsUntilATypeIsAskedFor) {
  RegistryOptions options = linked_in();
  options.builtins.push_back({"one", &plain_entry});
  Registry registry(std::move(options));
  expect_value(registry.joint("revolute", {}));
  EXPECT_EQ(diary.inits, 0);
  expect_value(registry.function("one", {}));
  expect_value(registry.function("one", {}));
  EXPECT_EQ(diary.inits, 1);
}

TEST_F(Loading, StartsAndStopsAPluginOnce) {
  {
    Registry registry(linked_in());
    ASSERT_TRUE(registry.add(diary_entry));
    ASSERT_TRUE(registry.add(diary_entry));
    expect_value(registry.function("diary.one", {}));
    expect_value(registry.function("diary.two", {}));
    EXPECT_EQ(diary.inits, 1);
    EXPECT_EQ(diary.deinits, 0);
  }
  EXPECT_EQ(diary.deinits, 1);
}

TEST_F(Loading, KeepsAPluginAsLongAsItsInstances) {
  auto registry = std::make_unique<Registry>(linked_in());
  ASSERT_TRUE(registry->add(diary_entry));
  auto instance = std::make_unique<Instance>(
      expect_value(create(*expect_value(registry->function("diary.one", {})), {{"vector", {1, 2, 3}}})));
  registry.reset();
  EXPECT_EQ(diary.deinits, 0);
  EXPECT_EQ(diary.instances, 1);
  instance.reset();
  EXPECT_EQ(diary.instances, 0);
  EXPECT_EQ(diary.deinits, 1);
}

TEST_F(Loading, KeepsASharedObjectAsLongAsItsInstances) {
  auto registry = std::make_unique<Registry>(with_strangers());
  const JointType* type = expect_value(registry->joint("acme.helical", {}));
  Instance instance = expect_value(create(*type, {{"pitch", {0.5}}}));
  const auto motions = type->calls.motions;
  registry.reset();
  koppel_motion motion{};
  ASSERT_EQ(motions(instance.get(), &motion), KOPPEL_OK);
  EXPECT_EQ(motion.pitch, 0.5);
}

TEST_F(Loading, TellsAPluginWhoItsHostIs) {
  Registry registry(linked_in());
  ASSERT_TRUE(registry.add(diary_entry));
  EXPECT_EQ(diary.host.major, KOPPEL_ABI_MAJOR);
  EXPECT_EQ(diary.host.minor, KOPPEL_ABI_MINOR);
}

TEST_F(Loading, PassesOnWhatAPluginLogs) {
  std::ostringstream lines;
  RegistryOptions options = linked_in();
  options.log = std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(lines));
  Registry registry(std::move(options));
  ASSERT_TRUE(registry.add(diary_entry));
  EXPECT_NE(lines.str().find("diary: dear diary"), std::string::npos) << lines.str();
}

TEST_F(Loading, RefusesAPluginForANewerEngine) {
  Registry registry(linked_in());
  const koppel_plugin_entry newer = entry_of(two_functions<diary_one, diary_two>, KOPPEL_ABI_MINOR + 1);
  const auto added = registry.add(newer);
  ASSERT_FALSE(added);
  EXPECT_EQ(added.error().code, Code::plugin_version);
  EXPECT_EQ(diary.inits, 0);
}

TEST_F(Loading, AcceptsAnEntryThatHasGrown) {
  struct Grown {
    koppel_plugin_entry known;
    void (*unknown)();
  };
  Grown grown{diary_entry, nullptr};
  grown.known.struct_size = sizeof(Grown);
  Registry registry(linked_in());
  EXPECT_TRUE(registry.add(grown.known));
}

TEST_F(Loading, RefusesATypeThatIsTaken) {
  Registry registry(linked_in());
  ASSERT_TRUE(registry.add(diary_entry));
  const koppel_plugin_entry again = diary_entry;
  const auto added = registry.add(again);
  ASSERT_FALSE(added);
  EXPECT_EQ(added.error().code, Code::type_taken);
  expect_mentions(added.error(), {"diary.one"});
}

TEST_F(Loading, RefusesPlainNamesFromStrangers) {
  Registry registry(linked_in());
  const auto added = registry.add(plain_entry);
  ASSERT_FALSE(added);
  expect_mentions(added.error(), {"`one`", "belong to koppel"});
  EXPECT_EQ(diary.deinits, diary.inits);
}

using Values = WithDiary;

TEST_F(Values, ReachThePluginInTheOrderOfTheSchema) {
  Registry registry(linked_in());
  ASSERT_TRUE(registry.add(diary_entry));
  const Type* type = expect_value(registry.function("diary.one", {}));
  const std::vector<Value> values = {{true, 3, {1, 2, 3}, ""}, {true, 1, {}, "text"}, {}, {true, 1, {1}, ""}};
  const Instance instance = expect_value(type->create(values));
  EXPECT_EQ(instance.get(), &diary);
  EXPECT_EQ(diary.values[0].given, 1);
  EXPECT_EQ(diary.numbers, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(diary.values[0].text, nullptr);
  EXPECT_EQ(diary.text, "text");
  EXPECT_EQ(diary.values[2].given, 0);
  EXPECT_EQ(diary.values[2].count, 0u);
  EXPECT_EQ(diary.values[2].text, nullptr);
  EXPECT_EQ(diary.values[3].count, 1u);
  for (const koppel_value& value : diary.values) EXPECT_EQ(value.struct_size, sizeof(koppel_value));
}

TEST_F(Values, MustBeAsManyAsParameters) {
  Registry registry(linked_in());
  ASSERT_TRUE(registry.add(diary_entry));
  EXPECT_FALSE(expect_value(registry.function("diary.one", {}))->create({}));
}

TEST_F(Values, AreNotNeededByATypeThatKeepsNothing) {
  Registry registry(linked_in());
  const Instance instance = expect_value(create(*expect_value(registry.joint("revolute", {})), {}));
  EXPECT_EQ(instance.get(), nullptr);
}

}  // namespace
}  // namespace koppel::test
