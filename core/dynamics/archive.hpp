// What a simulation goes on from, as bytes: one function for each class tells its members, for writing and reading.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include <Eigen/Core>

namespace koppel {

/// Writes members in the order in which it is called with them, or reads them in the same order. Numbers as this
/// machine holds them.
class Archive {
 public:
  /// Writes to the end of `to`.
  explicit Archive(std::vector<unsigned char>& to) : to_(&to) {}
  explicit Archive(std::span<const unsigned char> from) : from_(from) {}

  bool is_reading() const { return to_ == nullptr; }
  /// Everything was there so far. What could not be read is as it was.
  bool good() const { return good_; }
  /// Nothing is left to read.
  bool at_end() const { return from_.empty(); }

  template <typename Number>
  requires std::is_arithmetic_v<Number> || std::is_enum_v<Number>
  void operator()(Number& x) { bytes(&x, sizeof x); }

  /// Its size, too.
  void operator()(Eigen::VectorXd& x) {
    auto size = static_cast<std::uint64_t>(x.size());
    (*this)(size);
    if (is_reading()) {
      good_ = good_ && size <= from_.size() / sizeof(double);
      if (!good_) return;
      x.resize(static_cast<Eigen::Index>(size));
    }
    bytes(x.data(), static_cast<std::size_t>(size) * sizeof(double));
  }

  template <typename... Members>
  requires(sizeof...(Members) > 1) void operator()(Members&... members) { ((*this)(members), ...); }

 private:
  void bytes(void* data, std::size_t size) {
    if (size == 0) return;
    if (!is_reading()) {
      const auto* first = static_cast<const unsigned char*>(data);
      to_->insert(to_->end(), first, first + size);
      return;
    }
    good_ = good_ && size <= from_.size();
    if (!good_) return;
    std::memcpy(data, from_.data(), size);
    from_ = from_.subspan(size);
  }

  std::vector<unsigned char>* to_ = nullptr;
  std::span<const unsigned char> from_;
  bool good_ = true;
};

}  // namespace koppel
