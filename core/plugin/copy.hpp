// Copies of structs that start with their own size: what the writer did not know yet reads as zero.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace koppel {

/// How many bytes a struct has up to and including a member: the size that a first version must at least have.
template <typename Struct, typename Member>
std::size_t size_through(Member Struct::*member) {
  const Struct sample{};
  return static_cast<std::size_t>(reinterpret_cast<const char*>(&(sample.*member)) -
                                  reinterpret_cast<const char*>(&sample)) +
         sizeof(Member);
}

/// The struct as this version knows it. The caller has checked that its struct_size is sensible.
template <typename Struct>
Struct copy_struct(const Struct* from) {
  std::uint32_t size = 0;
  std::memcpy(&size, from, sizeof size);
  Struct out{};
  std::memcpy(&out, from, std::min<std::size_t>(size, sizeof(Struct)));
  out.struct_size = sizeof(Struct);
  return out;
}

/// The index-th element of an array whose elements are `stride` bytes apart.
template <typename Struct>
const Struct* array_element(const Struct* first, std::size_t stride, std::size_t index) {
  return reinterpret_cast<const Struct*>(reinterpret_cast<const char*>(first) + stride * index);
}

}  // namespace koppel
