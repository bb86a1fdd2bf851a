// Whatever the text, reading ends soon, with a scene or with errors that stand in the text.
#include <algorithm>
#include <chrono>
#include <random>
#include <sstream>

#include "scene_reader.hpp"

namespace koppel {
namespace {

const std::string good_scene =
    "schema = 1\n[scene]\nname = \"fourbar\"\ntitle = \"Gr\xc3\xbc\xc3\x9f"
    "e\"\nlength = 0.4\nsteps = 36\n"
    "[parameters]\nground = 0.40\ncrank = \"3/10 * ground\"\n"
    "[[body]]\nname = \"crank\"\nmass = 1.5\n[[body]]\nname = 'coupler'\nrotate = [['x', '30 deg'], ['z', '-90 deg']]\n"
    "[[frame]]\nname = 'tip'\non = 'coupler'\nat = ['2*crank*sin(30 deg)', 0, '120 mm']\naxis = [1, 0, 0]\n"
    "[[joint]]\nname = 'pin'\ntype = 'revolute'\nbetween = ['ground', 'crank']\nat = [0.1, 0, 0]\naxis = [0, 1, 0]\n"
    "zero = { angle = '60 deg' }\nlimits = { angle = ['-20 deg', '80 deg'] }\n"
    "[[joint]]\nname = 'ball'\ntype = 'spherical'\ninlet = 'crank'\noutlet = { on = 'coupler', at = [0.1, 0, 0] }\n"
    "start = { rotation = [1, 0, 0, 0] }\n"
    "[[constraint]]\nname = 'rod'\ntype = 'distance'\nfrom = 'tip'\nto = 'ground'\ndistance = '0.5 m'\n"
    "[[drive]]\nof = 'pin.angle'\ntype = 'table'\npoints = [[0, 0], [1, '1 rev'], [2, 3]]\n"
    "[[force]]\nname = 'coil'\ntype = 'spring'\nfrom = 'tip'\nto = 'ground'\nstiffness = '2e3'\nlength = '300 mm'\n"
    "[[force]]\nname = 'brake'\ntype = 'coordinate_spring'\nof = 'pin.angle'\nstiffness = 10\ndamping = 0.1\n"
    "[[watch]]\nof = 'pin.angle'\nquantity = 'rate'\nvalue = '-5 deg'\ndirection = 'falling'\nstop = true\n"
    "[simulation]\nintegrator = 'ida'\nformulation = 'ggl'\ntolerance = 1e-6\n"
    "[[record]]\nof = 'ball'\nquantity = 'cardan'\n"
    "[[record]]\nof = 'tip'\nquantity = 'velocity'\nby = 'pin.angle'\n"
    "[[record]]\nof = 'coupler'\nquantity = 'moving_axode'\nagainst = 'crank'\n";

/// Reads the text; a scene comes without errors, errors come with a place in the text.
void expect_sane(SceneReader& reader, const std::string& text) {
  const auto scene = reader.read(text);
  ASSERT_EQ(scene.has_value(), !reader.diagnostics.has_errors()) << text;
  const auto lines = 1 + std::count(text.begin(), text.end(), '\n');
  for (const Error& finding : reader.diagnostics.findings()) {
    ASSERT_FALSE(finding.message.empty()) << text;
    ASSERT_GE(finding.source.line, 1) << text << '\n' << render(finding);
    ASSERT_LE(finding.source.line, lines) << text << '\n' << render(finding);
    ASSERT_GE(finding.source.column, 1) << text << '\n' << render(finding);
    ASSERT_LE(finding.source.column + finding.source.length, static_cast<int>(finding.source.line_text.size()) + 2)
        << text << '\n'
        << render(finding);
    ASSERT_NE(finding.code, Code::internal) << text << '\n' << render(finding);
  }
}

TEST(Any_text, the_good_scene_is_good) {
  SceneReader reader;
  reader.good(good_scene);
}

TEST(Any_text, may_end_anywhere) {
  SceneReader reader;
  for (std::size_t length = 0; length <= good_scene.size(); ++length) expect_sane(reader, good_scene.substr(0, length));
}

TEST(Any_text, may_have_any_bytes_changed) {
  SceneReader reader;
  std::mt19937 random(20240229);
  const std::string likely = "[]{}()\"'=.,#\n -+*/^?:eE0123456789abmstx\\";
  for (int round = 0; round < 4000; ++round) {
    std::string text = good_scene;
    for (std::uint32_t changes = 1 + random() % 4; changes > 0; --changes) {
      const std::size_t at = random() % text.size();
      const char byte = random() % 8 == 0 ? static_cast<char>(random() % 256) : likely[random() % likely.size()];
      switch (random() % 4) {
        case 0: text.erase(at, 1 + random() % 8); break;
        case 1: text.insert(at, 1, byte); break;
        case 2: text.insert(at, text.substr(random() % text.size(), random() % 40)); break;
        default: text[at] = byte; break;
      }
    }
    expect_sane(reader, text);
    if (HasFatalFailure()) return;
  }
}

TEST(Any_text, may_nest_deeply) {
  SceneReader reader;
  const auto repeated = [](const std::string& part, int count) {
    std::string out;
    for (int i = 0; i < count; ++i) out += part;
    return out;
  };
  const std::string deep[] = {
      "schema = 1\na = " + repeated("[", 10000),
      "schema = 1\na = " + repeated("{a = ", 10000),
      "schema = 1\na" + repeated(".a", 300000) + " = 1\n",
      "schema = 1\na" + repeated(" . \"a\"", 300000) + " = 1\n",
      "schema = 1\n[a" + repeated(".a", 300000) + "]\n",
      "schema = 1\nx = " + repeated("{ a" + repeated(".a", 32) + " = ", 250) + "1" + repeated("}", 250) + "\n",
      "schema = 1\n[scene]\nlength = '" + repeated("(", 5000) + "1" + repeated(")", 5000) + "'\n",
      "schema = 1\n[scene]\nlength = '" + repeated("-", 5000) + "1'\n",
      "schema = 1\n[scene]\nlength = '" + repeated("1 ? 2 : ", 2000) + "1'\n",
      "schema = 1\n[scene]\nlength = '" + repeated("sin(", 4000) + "1" + repeated(")", 4000) + "'\n",
      "schema = 1\n[scene]\nlength = '" + repeated("1+", 100000) + "1'\n",
  };
  for (const std::string& text : deep) {
    const auto scene = reader.read(text);
    EXPECT_EQ(scene.has_value(), !reader.diagnostics.has_errors()) << text.substr(0, 40);
  }
}

TEST(Any_text, is_read_in_bounded_time) {
  std::ostringstream text("schema = 1\n[[body]]\nname = 'b0'\n", std::ios::ate);
  for (int i = 1; i <= 2000; ++i) {
    text << "[[body]]\nname = 'b" << i << "'\n[[joint]]\nname = 'j" << i << "'\ntype = 'revolute'\nbetween = ['b"
         << i - 1 << "', 'b" << i << "']\nat = ['" << i << " mm', 0, 0]\n";
  }
  text << "[[joint]]\nname = 'base'\ntype = 'weld'\nbetween = ['ground', 'b0']\n";
  SceneReader reader;
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(reader.good(text.str()).joints.size(), 2001u);
  // A hundred times what it takes; growth with the square of the size would not pass.
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

}  // namespace
}  // namespace koppel
