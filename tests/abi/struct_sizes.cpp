// Callers that were compiled with another version of the headers: their structs are shorter or longer than ours.
#include <algorithm>
#include <array>

#include "folders.hpp"
#include "host.hpp"

namespace koppel::test {
namespace {

/// Memory for a struct that is `extra` bytes longer than ours, or shorter, with a pattern behind it.
template <typename Struct>
class Sized {
 public:
  explicit Sized(std::ptrdiff_t extra) : size_(sizeof(Struct) + static_cast<std::size_t>(extra)) {
    bytes_.fill(pattern);
    get()->struct_size = static_cast<std::uint32_t>(size_);
  }
  Struct* get() { return reinterpret_cast<Struct*>(bytes_.data()); }
  std::uint32_t size() { return get()->struct_size; }
  /// What lies beyond the caller's struct belongs to the caller.
  bool intact_behind() const {
    return std::all_of(bytes_.begin() + static_cast<std::ptrdiff_t>(size_), bytes_.end(),
                       [](auto b) { return b == pattern; });
  }
  /// What we do not know of a newer caller's struct is zero.
  bool tail_is_zero() const {
    return std::all_of(bytes_.begin() + sizeof(Struct), bytes_.begin() + static_cast<std::ptrdiff_t>(size_),
                       [](auto b) { return b == 0; });
  }
  const unsigned char* bytes() const { return bytes_.data(); }

 private:
  static constexpr unsigned char pattern = 0x5a;
  std::size_t size_;
  alignas(16) std::array<unsigned char, sizeof(Struct) + 64> bytes_;
};

/// An output struct written for callers of all ages; write(struct*) must succeed and give the same every time.
template <typename Struct, typename Write>
void expect_all_ages_served(const Write& write) {
  Sized<Struct> ours(0);
  write(ours.get());
  ASSERT_EQ(ours.size(), sizeof(Struct));
  EXPECT_TRUE(ours.intact_behind());

  Sized<Struct> newer(32);
  write(newer.get());
  EXPECT_EQ(newer.size(), sizeof(Struct) + 32);
  EXPECT_TRUE(newer.tail_is_zero());
  EXPECT_TRUE(newer.intact_behind());

  constexpr std::size_t word = sizeof(std::uint32_t);
  for (std::ptrdiff_t size = word; size < static_cast<std::ptrdiff_t>(sizeof(Struct)); size += word) {
    Sized<Struct> older(size - static_cast<std::ptrdiff_t>(sizeof(Struct)));
    write(older.get());
    EXPECT_EQ(older.size(), static_cast<std::uint32_t>(size));
    EXPECT_TRUE(older.intact_behind()) << size;
    EXPECT_EQ(std::memcmp(older.bytes() + word, ours.bytes() + word, static_cast<std::size_t>(size) - word), 0) << size;
  }
}

TEST(StructSizes, OfOutputsMayDiffer) {
  const Host host("5link");
  const koppel_mechanism* mechanism = host.mechanism.get();
  koppel_state* state = host.state.get();
  koppel_work* work = host.work.get();
  ASSERT_GE(host.move(0.5), KOPPEL_OK);
  expect_all_ages_served<koppel_sizes>(
      [&](auto* out) { EXPECT_EQ(koppel_mechanism_sizes(mechanism, out), KOPPEL_OK); });
  expect_all_ages_served<koppel_settings>(
      [&](auto* out) { EXPECT_EQ(koppel_mechanism_settings(mechanism, out), KOPPEL_OK); });
  expect_all_ages_served<koppel_closure>(
      [&](auto* out) { EXPECT_EQ(koppel_mechanism_closure(mechanism, 4, out, nullptr, 0), KOPPEL_OK); });
  expect_all_ages_served<koppel_inertia>(
      [&](auto* out) { EXPECT_EQ(koppel_body_inertia(mechanism, 1, out, nullptr), KOPPEL_OK); });
  expect_all_ages_served<koppel_report>(
      [&](auto* out) { EXPECT_GE(koppel_close(state, work, nullptr, out, nullptr), KOPPEL_OK); });
  expect_all_ages_served<koppel_analysis>(
      [&](auto* out) { EXPECT_EQ(koppel_analyse(state, work, out, nullptr), KOPPEL_OK); });
  expect_all_ages_served<koppel_freedoms>(
      [&](auto* out) { EXPECT_EQ(koppel_find_freedoms(state, work, out, nullptr), KOPPEL_OK); });
}

TEST(StructSizes, OfModesMayDiffer) {
  const Host host("rstr");
  koppel_modes* found = nullptr;
  ASSERT_EQ(koppel_modes_find(host.state.get(), host.work.get(), nullptr, &found, nullptr), KOPPEL_OK);
  const Modes modes(found);
  expect_all_ages_served<koppel_modes_summary>(
      [&](auto* out) { EXPECT_EQ(koppel_modes_summarise(found, out), KOPPEL_OK); });
  expect_all_ages_served<koppel_mode>([&](auto* out) { EXPECT_EQ(koppel_modes_get(found, 0, out), KOPPEL_OK); });
}

TEST(StructSizes, OfErrorsMayDiffer) {
  const Engine engine = make_engine();
  expect_all_ages_served<koppel_error>([&](auto* out) {
    koppel_scene* scene = nullptr;
    EXPECT_EQ(koppel_scene_from_text(engine.get(), "schema = 2", 10, nullptr, nullptr, &scene, out),
              KOPPEL_INVALID_SCENE);
  });
}

TEST(StructSizes, OfStatisticsMayDiffer) {
  const Host host("5link");
  expect_all_ages_served<koppel_stream_statistics>([&](auto* out) {
    auto options = sized<koppel_stream_options>();
    options.url = "memq://";
    koppel_stream* stream = nullptr;
    ASSERT_EQ(koppel_stream_open(host.mechanism.get(), &options, &stream, nullptr), KOPPEL_OK);
    ASSERT_EQ(koppel_stream_publish(stream, host.state.get(), host.work.get(), nullptr), KOPPEL_OK);
    EXPECT_EQ(koppel_stream_close(stream, out), KOPPEL_OK);
  });
}

TEST(StructSizes, OfZeroReceiveNothing) {
  const Host host("rstr");
  Output<koppel_sizes> out;
  out.value.struct_size = 0;
  const koppel_sizes before = out.value;
  EXPECT_EQ(koppel_mechanism_sizes(host.mechanism.get(), &out), KOPPEL_OK);
  EXPECT_EQ(std::memcmp(&before, &out.value, sizeof before), 0);
}

TEST(StructSizes, OfOptionsMayBeOlder) {
  const Host host("5link");
  // An older caller's options end before the tolerance: what lies there is not ours to read.
  auto options = sized<koppel_close_options>();
  options.struct_size = offsetof(koppel_close_options, tolerance);
  options.method = KOPPEL_METHOD_CERES;
  options.tolerance = -1.0;
  auto report = sized<koppel_report>();
  EXPECT_GE(koppel_close(host.state.get(), host.work.get(), &options, &report, nullptr), KOPPEL_OK);
  EXPECT_EQ(report.solver, KOPPEL_SOLVER_CERES);
  options.struct_size = sizeof options;
  EXPECT_EQ(koppel_close(host.state.get(), host.work.get(), &options, &report, nullptr), KOPPEL_INVALID_ARGUMENT);
  // An engine's options end before the log.
  auto engine_options = sized<koppel_engine_options>();
  engine_options.struct_size = offsetof(koppel_engine_options, log);
  engine_options.log = [](void*, std::int32_t, const char*) { FAIL() << "an option was read that is not there"; };
  koppel_engine* engine = nullptr;
  ASSERT_EQ(koppel_engine_create(KOPPEL_ABI_MAJOR, KOPPEL_ABI_MINOR, &engine_options, &engine, nullptr), KOPPEL_OK);
  const Engine owned(engine);
  koppel_scene* scene = nullptr;
  ASSERT_EQ(koppel_scene_from_file(engine, (scenes_folder() + "/rstr.toml").c_str(), nullptr, &scene, nullptr),
            KOPPEL_OK);
  koppel_scene_destroy(scene);
}

TEST(StructSizes, OfOptionsOfASearchMayBeOlder) {
  const Host host("rstr");
  auto options = sized<koppel_modes_options>();
  options.struct_size = offsetof(koppel_modes_options, progress);
  options.most = 2;
  options.progress = [](std::size_t, double, void*) -> std::int32_t {
    ADD_FAILURE() << "an option was read that is not there";
    return 1;
  };
  koppel_modes* found = nullptr;
  ASSERT_EQ(koppel_modes_find(host.state.get(), host.work.get(), &options, &found, nullptr), KOPPEL_OK);
  const Modes modes(found);
  auto summary = sized<koppel_modes_summary>();
  ASSERT_EQ(koppel_modes_summarise(found, &summary), KOPPEL_OK);
  EXPECT_EQ(summary.count, 2u);
  EXPECT_EQ(summary.complete, 0);
}

TEST(StructSizes, OfOptionsMayBeNewer) {
  const Host host("5link");
  Sized<koppel_close_options> options(32);
  options.get()->method = KOPPEL_METHOD_CERES;
  options.get()->max_iterations = 0;
  options.get()->tolerance = 0.0;
  EXPECT_GE(koppel_close(host.state.get(), host.work.get(), options.get(), nullptr, nullptr), KOPPEL_OK);
}

TEST(Version, IsTheHeaders) {
  const koppel_version version = koppel_library_version();
  EXPECT_EQ(version.major, KOPPEL_ABI_MAJOR);
  EXPECT_EQ(version.minor, KOPPEL_ABI_MINOR);
  EXPECT_EQ(version.patch, KOPPEL_ABI_PATCH);
}

TEST(Version, ThatIsNewerOrOfAnotherMajorIsRefused) {
  Output<koppel_engine*> engine;
  for (const auto& [major, minor] :
       {std::pair{KOPPEL_ABI_MAJOR, KOPPEL_ABI_MINOR + 1}, std::pair{KOPPEL_ABI_MAJOR + 1, 0u},
        std::pair{KOPPEL_ABI_MAJOR + 1, KOPPEL_ABI_MINOR}, std::pair{KOPPEL_ABI_MAJOR, UINT32_MAX}}) {
    auto error = sized<koppel_error>();
    EXPECT_EQ(koppel_engine_create(major, minor, nullptr, &engine, &error), KOPPEL_VERSION) << major << "." << minor;
    EXPECT_EQ(error.status, KOPPEL_VERSION);
    EXPECT_STREQ(error.code, "E0902");
    EXPECT_STRNE(error.advice, "");
  }
  EXPECT_TRUE(engine.untouched());
}

TEST(Version, ThatIsOlderIsServed) {
  for (std::uint32_t minor = 0; minor <= KOPPEL_ABI_MINOR; ++minor) {
    koppel_engine* engine = nullptr;
    EXPECT_EQ(koppel_engine_create(KOPPEL_ABI_MAJOR, minor, nullptr, &engine, nullptr), KOPPEL_OK);
    koppel_engine_destroy(engine);
  }
}

}  // namespace
}  // namespace koppel::test
