// The message types are frozen: what a listener of today decodes, it decodes tomorrow.
#include <bit>
#include <cstdint>

#include <gtest/gtest.h>

#include "koppel/closure_t.hpp"
#include "koppel/event_t.hpp"
#include "koppel/koppel.h"
#include "koppel/model_t.hpp"
#include "koppel/pose_t.hpp"
#include "koppel/poses_t.hpp"
#include "koppel/state_t.hpp"

namespace koppel {
namespace {

template <typename Type>
std::uint64_t fingerprint() {
  return std::bit_cast<std::uint64_t>(static_cast<std::int64_t>(Type::getHash()));
}

// A change of these numbers breaks every listener and every old log. A message that must change gets a new name.
TEST(MessageTypes, KeepTheirFingerprints) {
  EXPECT_EQ(fingerprint<model_t>(), 0x8f34ada224844f56u);
  EXPECT_EQ(fingerprint<state_t>(), 0xb710dd4b6d6aaff7u);
  EXPECT_EQ(fingerprint<pose_t>(), 0x83f32f6564dd08c2u);
  EXPECT_EQ(fingerprint<poses_t>(), 0x3665d0a590352529u);
  EXPECT_EQ(fingerprint<closure_t>(), 0x10d718ca59037a8au);
  EXPECT_EQ(fingerprint<event_t>(), 0xe5a9920ae147e7f8u);
}

TEST(MessageTypes, UseTheNumbersOfTheCInterface) {
  EXPECT_EQ(int{closure_t::VERDICT_OPEN}, int{KOPPEL_VERDICT_OPEN});
  EXPECT_EQ(int{closure_t::VERDICT_CLOSED}, int{KOPPEL_VERDICT_CLOSED});
  EXPECT_EQ(int{closure_t::VERDICT_NOT_FOUND}, int{KOPPEL_VERDICT_NOT_FOUND});
  EXPECT_EQ(int{closure_t::VERDICT_RETRY}, int{KOPPEL_VERDICT_RETRY});
  EXPECT_EQ(int{closure_t::SOLVER_NONE}, int{KOPPEL_SOLVER_NONE});
  EXPECT_EQ(int{closure_t::SOLVER_NEWTON}, int{KOPPEL_SOLVER_NEWTON});
  EXPECT_EQ(int{closure_t::SOLVER_CERES}, int{KOPPEL_SOLVER_CERES});
  EXPECT_EQ(int{event_t::SEVERITY_NOTE}, int{KOPPEL_SEVERITY_NOTE});
  EXPECT_EQ(int{event_t::SEVERITY_WARNING}, int{KOPPEL_SEVERITY_WARNING});
  EXPECT_EQ(int{event_t::SEVERITY_ERROR}, int{KOPPEL_SEVERITY_ERROR});
}

}  // namespace
}  // namespace koppel
