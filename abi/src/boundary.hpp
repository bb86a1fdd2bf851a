// The boundary: nothing but values and status codes crosses it.
#pragma once

#include <algorithm>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <string_view>

#include "base/error.hpp"
#include "handles.hpp"
#include "koppel/koppel.h"

namespace koppel {

/// The status that stands for a finding at the boundary.
koppel_status status_of(Code code);

/// Fills a caller's error (may be null) and returns the status.
koppel_status fail(const Error& error, koppel_error* out);
koppel_status fail(koppel_status status, const Error& error, koppel_error* out);
koppel_status invalid_argument(std::string message, koppel_error* out);

/// Both are there and belong to the same mechanism.
inline bool fit(const koppel_state* state, const koppel_work* work) {
  return state != nullptr && work != nullptr && state->mechanism == work->work.mechanism;
}

/// Writes a text as koppel.h promises.
koppel_status write_text(std::string_view text, char* buffer, std::size_t size, std::size_t* needed);

/// Copies a struct of ours into a caller's that may be older (shorter) or newer (its tail becomes zero).
template <typename Struct>
void write_struct(const Struct& from, Struct* to) {
  constexpr std::uint32_t implausible = 1u << 16;  // larger than any version will get: not a size, then
  const std::uint32_t size = std::min(to->struct_size, implausible);
  const std::size_t common = std::min<std::size_t>(size, sizeof(Struct));
  std::memcpy(to, &from, common);
  if (size > common) std::memset(reinterpret_cast<char*>(to) + common, 0, size - common);
  to->struct_size = size;
}

/// Reads a caller's struct; what it does not have is zero. Null gives all zero.
template <typename Struct>
Struct read_struct(const Struct* from) {
  Struct result{};
  if (from != nullptr) std::memcpy(&result, from, std::min<std::size_t>(from->struct_size, sizeof(Struct)));
  return result;
}

/// Like fail(), but allocates nothing.
koppel_status fail_without_memory(koppel_error* out, koppel_status status, const char* code,
                                  const char* message) noexcept;

/// Runs the body of an exported function; whatever it throws becomes a status.
template <typename Body>
koppel_status guarded(koppel_error* error, const Body& body) noexcept {
  try {
    return body();
  } catch (const std::bad_alloc&) {
    return fail_without_memory(error, KOPPEL_NO_MEMORY, "E0903", "there is no memory left");
  } catch (const std::exception& problem) {
    return fail_without_memory(error, KOPPEL_INTERNAL, "E0904", problem.what());
  } catch (...) {
    return fail_without_memory(error, KOPPEL_INTERNAL, "E0904", "an unknown exception");
  }
}

}  // namespace koppel
