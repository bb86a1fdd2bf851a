// What the library says: texts in buffers of any size, errors with all their fields, an explanation for every code.
#include "host.hpp"

namespace koppel::test {
namespace {

TEST(Texts, AreCutToTheBufferAndEnded) {
  const Host host("5link");
  const std::string whole = text_of([&](char* text, std::size_t size, std::size_t* needed) {
    return koppel_mechanism_explain(host.mechanism.get(), text, size, needed);
  });
  ASSERT_GT(whole.size(), 100u);
  for (const std::size_t size :
       {std::size_t{1}, std::size_t{2}, std::size_t{100}, whole.size(), whole.size() + 1, whole.size() + 50}) {
    std::string buffer(whole.size() + 60, '#');
    std::size_t needed = 0;
    ASSERT_EQ(koppel_mechanism_explain(host.mechanism.get(), buffer.data(), size, &needed), KOPPEL_OK);
    EXPECT_EQ(needed, whole.size() + 1);
    EXPECT_STREQ(buffer.c_str(), whole.substr(0, size - 1).c_str());
    EXPECT_EQ(buffer.find_first_not_of('#', std::min(size, whole.size() + 1)), std::string::npos);
  }
}

TEST(Texts, WithoutRoomAreRefused) {
  const Host host("5link");
  std::size_t needed = 77;
  char nothing[1] = {'#'};
  EXPECT_EQ(koppel_mechanism_name(host.mechanism.get(), KOPPEL_KIND_BODY, 0, nothing, 0, &needed),
            KOPPEL_INVALID_ARGUMENT);
  EXPECT_EQ(nothing[0], '#');
  EXPECT_EQ(needed, 77u);
}

TEST(Names, AreFoundAgainUnderTheirIndex) {
  const Host host("5link");
  const koppel_mechanism* m = host.mechanism.get();
  for (std::int32_t kind = KOPPEL_KIND_BODY; kind <= KOPPEL_KIND_RECORD; ++kind) {
    std::size_t count = 0;
    for (;; ++count) {
      const std::string name = text_of([&](char* text, std::size_t size, std::size_t* needed) {
        return koppel_mechanism_name(m, kind, count, text, size, needed);
      });
      if (name.empty()) break;
      std::size_t index = SIZE_MAX;
      EXPECT_EQ(koppel_mechanism_find(m, kind, name.c_str(), &index, nullptr), KOPPEL_OK) << name;
      EXPECT_EQ(index, count) << name;
    }
    EXPECT_GT(count, 0u) << kind;
  }
}

TEST(Names, ThatAreMisspeltAreCorrected) {
  const Host host("5link");
  Output<std::size_t> index;
  auto error = sized<koppel_error>();
  EXPECT_EQ(koppel_mechanism_find(host.mechanism.get(), KOPPEL_KIND_JOINT, "weel", &index, &error),
            KOPPEL_INVALID_ARGUMENT);
  EXPECT_TRUE(index.untouched());
  EXPECT_NE(std::string(error.message).find("`weel`"), std::string::npos);
  EXPECT_NE(std::string(error.advice).find("`wheel`"), std::string::npos);
}

TEST(Errors, OfAFileSayWhereAndWhatToDo) {
  const Engine engine = make_engine();
  const std::string file = tests_folder() + "/abi/misspelt.toml";
  koppel_diagnostics* list = nullptr;
  ASSERT_EQ(koppel_diagnostics_create(&list), KOPPEL_OK);
  const Diagnostics owned(list);
  auto error = sized<koppel_error>();
  Output<koppel_scene*> scene;
  EXPECT_EQ(koppel_scene_from_file(engine.get(), file.c_str(), list, &scene, &error), KOPPEL_INVALID_SCENE);
  EXPECT_TRUE(scene.untouched());
  EXPECT_EQ(error.status, KOPPEL_INVALID_SCENE);
  EXPECT_EQ(error.severity, KOPPEL_SEVERITY_ERROR);
  EXPECT_STREQ(error.code, "E0306");
  EXPECT_EQ(std::string(error.file), file);
  EXPECT_EQ(error.line, 8);
  EXPECT_EQ(error.column, 8);
  EXPECT_EQ(error.length, 9);  // with its quotation marks
  EXPECT_STREQ(error.source_line, "type = \"revolut\"");
  EXPECT_STREQ(error.element, "joint pivot");
  EXPECT_NE(std::string(error.message).find("revolut"), std::string::npos);
  EXPECT_NE(std::string(error.advice).find("`revolute`"), std::string::npos);
  // Both faults of the file are told in one run, the first of them as the error.
  ASSERT_EQ(koppel_diagnostics_count(list), 2u);
  auto finding = sized<koppel_error>();
  ASSERT_EQ(koppel_diagnostics_get(list, 0, &finding), KOPPEL_OK);
  EXPECT_EQ(std::memcmp(&finding, &error, sizeof error), 0);
  ASSERT_EQ(koppel_diagnostics_get(list, 1, &finding), KOPPEL_OK);
  EXPECT_STREQ(finding.code, "E0304");
  Output<koppel_error> none;
  EXPECT_EQ(koppel_diagnostics_get(list, 2, &none), KOPPEL_INVALID_ARGUMENT);
  EXPECT_TRUE(none.untouched());
}

TEST(Errors, OfAFileThatIsNotThereNameIt) {
  const Engine engine = make_engine();
  koppel_scene* scene = nullptr;
  auto error = sized<koppel_error>();
  EXPECT_EQ(koppel_scene_from_file(engine.get(), "/nowhere/at/all.toml", nullptr, &scene, &error), KOPPEL_IO);
  EXPECT_STREQ(error.code, "E0101");
  EXPECT_EQ(error.line, 0);
  EXPECT_NE((std::string(error.message) + error.file).find("/nowhere/at/all.toml"), std::string::npos);
}

TEST(Errors, OfPluginsNameThem) {
  const Engine engine = make_engine();
  const std::string folder = test_plugins_folder() + "/bad/";
  auto error = sized<koppel_error>();
  EXPECT_EQ(koppel_engine_load_plugin(engine.get(), (folder + "no_entry.so").c_str(), &error), KOPPEL_PLUGIN);
  EXPECT_STREQ(error.code, "E0503");
  EXPECT_NE((std::string(error.element) + error.message + error.file).find("no_entry.so"), std::string::npos);
  EXPECT_EQ(koppel_engine_load_plugin(engine.get(), (folder + "other_major.so").c_str(), &error), KOPPEL_VERSION);
  EXPECT_STREQ(error.code, "E0504");
  EXPECT_STRNE(error.message, "");
  EXPECT_STRNE(error.advice, "");
  EXPECT_EQ(koppel_engine_load_plugin(engine.get(), "/nowhere/plugin.so", &error), KOPPEL_PLUGIN);
  EXPECT_STREQ(error.code, "E0501");
}

TEST(Errors, OfALinkedInPluginAreToldToo) {
  const Engine engine = make_engine();
  koppel_plugin_entry entry{};
  auto error = sized<koppel_error>();
  EXPECT_EQ(koppel_engine_add_plugin(engine.get(), &entry, &error), KOPPEL_PLUGIN);
  EXPECT_STREQ(error.code, "E0505");
  entry.struct_size = sizeof entry;
  entry.abi = {KOPPEL_ABI_MAJOR + 1, 0, 0};
  entry.name = "later";
  entry.type_table = [](const char*, std::size_t) -> const void* { return nullptr; };
  EXPECT_EQ(koppel_engine_add_plugin(engine.get(), &entry, &error), KOPPEL_VERSION);
  EXPECT_STREQ(error.code, "E0504");
}

TEST(Errors, LongerThanTheirFieldsAreCutAndEnded) {
  const Engine engine = make_engine();
  const std::string text = "schema = 1\n" + std::string(600, 'k') + " = 1\n";
  koppel_scene* scene = nullptr;
  auto error = sized<koppel_error>();
  EXPECT_EQ(koppel_scene_from_text(engine.get(), text.data(), text.size(), nullptr, nullptr, &scene, &error),
            KOPPEL_INVALID_SCENE);
  EXPECT_EQ(std::string(error.source_line), std::string(511, 'k'));
  EXPECT_EQ(error.length, 600);
  EXPECT_LT(std::strlen(error.message), sizeof error.message);
}

// The crank turns once in a second, so that it meets its limit of 30 degrees after 1/12 s.
TEST(Errors, OfAMoveNameTheTimeThatWasAskedFor) {
  const Host host(tests_folder() + "/abi/out_of_reach.toml");
  auto error = sized<koppel_error>();
  ASSERT_GE(host.move(0.0), 0);
  ASSERT_EQ(koppel_move(host.state.get(), host.work.get(), 0.125, nullptr, &error), KOPPEL_NOT_CLOSED);
  EXPECT_EQ(koppel_state_time(host.state.get()), 0.0);
  EXPECT_NE(std::string(error.message).find("at time 0.125 s"), std::string::npos) << error.message;
}

// At 90 degrees the pin is a crank's length from the slider's line, and the rod reaches half of that.
TEST(Errors, OfAssemblyTellHowFarItIsFromClosing) {
  const Host host(tests_folder() + "/abi/out_of_reach.toml");
  auto error = sized<koppel_error>();
  auto report = sized<koppel_report>();
  ASSERT_EQ(koppel_state_set_input(host.state.get(), 0, 1.5707963267948966, 0.0, 0.0), KOPPEL_OK);
  ASSERT_EQ(koppel_close(host.state.get(), host.work.get(), nullptr, &report, &error), KOPPEL_NOT_CLOSED);
  char off[32];
  std::snprintf(off, sizeof off, "%.3g", report.residual);
  EXPECT_NE(std::string(error.message).find("stays open by " + std::string(off)), std::string::npos) << error.message;
  EXPECT_NEAR(report.residual, 0.5,
              0.25);  // of the crank's length; the least-squares fit spreads it over the equations
}

TEST(Codes, AllHaveAnExplanation) {
  const std::pair<int, const char*> codes[] = {
#define KOPPEL_CODE(number, identifier, explanation) {number, #identifier},
#include "base/codes.inc"
#include "folders.hpp"
#undef KOPPEL_CODE
  };
  int last = 0;
  for (const auto& [number, identifier] : codes) {
    EXPECT_GT(number, last) << identifier;
    last = number;
    char code[8];
    std::snprintf(code, sizeof code, "E%04d", number);
    const std::string explanation = text_of([&](char* text, std::size_t size, std::size_t* needed) {
      return koppel_explain_code(code, text, size, needed);
    });
    EXPECT_GT(explanation.size(), 20u) << identifier;
    EXPECT_EQ(explanation.back(), '.') << identifier;
  }
}

TEST(Codes, ThatDoNotExistAreRefused) {
  char text[64] = "as before";
  std::size_t needed = 77;
  for (const char* code : {"", "E", "E0000", "E9999", "E0201x", "hello", "E99999999999999999999", "-201"}) {
    EXPECT_EQ(koppel_explain_code(code, text, sizeof text, &needed), KOPPEL_INVALID_ARGUMENT) << code;
  }
  EXPECT_STREQ(text, "as before");
  EXPECT_EQ(needed, 77u);
}

}  // namespace
}  // namespace koppel::test
