// A function of one library over a batch of inputs, in the library's own types: so each library does what it would do
// in a program written for it, and the way between the program and the library costs nothing per item.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include <benchmark/benchmark.h>

namespace koppel::bench {

/// How a type stands in a list of numbers: matrices column by column, quaternions w x y z, axis before angle, rotation
/// before position, angular before linear velocity.
///
///   static constexpr std::size_t size;
///   static Type read(const double* from);
///   static void write(const Type& value, Number* to);
template <typename Type>
struct Numbers;

template <std::size_t n>
struct Numbers<std::array<double, n>> {
  static constexpr std::size_t size = n;
  static std::array<double, n> read(const double* from) {
    std::array<double, n> value;
    for (std::size_t i = 0; i < n; ++i) value[i] = from[i];
    return value;
  }
  static void write(const std::array<double, n>& value, double* to) {
    for (std::size_t i = 0; i < n; ++i) to[i] = value[i];
  }
};

/// Several inputs, one after the other.
template <typename... Types>
struct Numbers<std::tuple<Types...>> {
  static constexpr std::size_t size = (Numbers<Types>::size + ...);
  static std::tuple<Types...> read(const double* from) {
    const auto next = [&from]<typename Type>() {
      const double* start = from;
      from += Numbers<Type>::size;
      return Numbers<Type>::read(start);
    };
    return {next.template operator()<Types>()...};  // braces: from left to right
  }
};

/// A function with its inputs.
class Batch {
 public:
  Batch() = default;
  Batch(const Batch&) = delete;
  Batch& operator=(const Batch&) = delete;
  virtual ~Batch() = default;

  /// Evaluates the first inputs, and drops the results.
  virtual void run(std::size_t count) const = 0;
  /// Numbers of all results.
  virtual std::vector<double> results() const = 0;
};

template <typename Function, typename... Inputs>
class BatchOf : public Batch {
 public:
  explicit BatchOf(const std::vector<double>& numbers) {
    using Input = Numbers<std::tuple<Inputs...>>;
    for (std::size_t i = 0; i < numbers.size(); i += Input::size) inputs_.push_back(Input::read(numbers.data() + i));
  }

  void run(std::size_t count) const override {
    for (std::size_t i = 0; i < count; ++i) {
      // A local variable: it is none of the inputs, as the compiler knows, and is copied nowhere.
      const auto result = std::apply(Function{}, inputs_[i]);
      benchmark::DoNotOptimize(result);
    }
  }

  std::vector<double> results() const override {
    using Output = Numbers<std::invoke_result_t<Function, const Inputs&...>>;
    std::vector<double> numbers(inputs_.size() * Output::size);
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      Output::write(std::apply(Function{}, inputs_[i]), numbers.data() + i * Output::size);
    }
    return numbers;
  }

 private:
  std::vector<std::tuple<Inputs...>> inputs_;
};

/// What a library offers, by the operations' names (those of operations.hpp).
class Library {
 public:
  /// function(const Inputs&...): a lambda that captures nothing, and returns a value that has Numbers.
  template <typename... Inputs, typename Function>
  void add(const std::string& operation, Function) {
    makers_[operation] = [](const std::vector<double>& numbers) -> std::unique_ptr<Batch> {
      return std::make_unique<BatchOf<Function, Inputs...>>(numbers);
    };
  }

  bool has(const std::string& operation) const { return makers_.contains(operation); }
  /// The operation on inputs that stand one after the other in the numbers.
  std::unique_ptr<Batch> batch(const std::string& operation, const std::vector<double>& numbers) const {
    return makers_.at(operation)(numbers);
  }

 private:
  std::map<std::string, std::unique_ptr<Batch> (*)(const std::vector<double>&)> makers_;
};

Library koppel_library();
Library eigen_library();
Library ceres_library();
Library kdl_library();
Library simbody_library();

}  // namespace koppel::bench
