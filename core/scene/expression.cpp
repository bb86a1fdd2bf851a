#include "scene/expression.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <exception>
#include <functional>
#include <numbers>
#include <optional>
#include <set>

#include <muParser.h>

namespace koppel {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

struct Unit {
  const char* name;
  const char* si;
  double (*to_si)(double);
};

// Divisions where the factor is no binary fraction: 120 mm is then the double nearest to 0.12.
constexpr auto units = std::to_array<Unit>({
    {"deg", "rad", [](double x) { return x * degree; }},
    {"rad", "rad", [](double x) { return x; }},
    {"rev", "rad", [](double x) { return x * 2.0 * std::numbers::pi; }},
    {"m", "m", [](double x) { return x; }},
    {"cm", "m", [](double x) { return x / 100.0; }},
    {"mm", "m", [](double x) { return x / 1000.0; }},
    {"s", "s", [](double x) { return x; }},
    {"ms", "s", [](double x) { return x / 1000.0; }},
    {"kg", "kg", [](double x) { return x; }},
    {"g", "kg", [](double x) { return x / 1000.0; }},
});

struct Function {
  const char* name;
  double (*of)(double);
};

constexpr auto functions = std::to_array<Function>({
    {"sin", [](double x) { return std::sin(x); }},
    {"cos", [](double x) { return std::cos(x); }},
    {"tan", [](double x) { return std::tan(x); }},
    {"asin", [](double x) { return std::asin(x); }},
    {"acos", [](double x) { return std::acos(x); }},
    {"atan", [](double x) { return std::atan(x); }},
    {"sinh", [](double x) { return std::sinh(x); }},
    {"cosh", [](double x) { return std::cosh(x); }},
    {"tanh", [](double x) { return std::tanh(x); }},
    {"sqrt", [](double x) { return std::sqrt(x); }},
    {"exp", [](double x) { return std::exp(x); }},
    {"log", [](double x) { return std::log(x); }},
    {"abs", [](double x) { return std::abs(x); }},
    {"sign", [](double x) { return x > 0.0 ? 1.0 : (x < 0.0 ? -1.0 : 0.0); }},
});
constexpr auto functions_of_more = std::to_array<std::string_view>({"atan2", "min", "max"});

double arc_tangent(double y, double x) { return std::atan2(y, x); }
double least(const double* x, int count) { return *std::min_element(x, x + count); }
double greatest(const double* x, int count) { return *std::max_element(x, x + count); }

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

const Unit* find_unit(std::string_view name) {
  const auto found = std::find_if(units.begin(), units.end(), [name](const Unit& u) { return name == u.name; });
  return found == units.end() ? nullptr : &*found;
}

/// What muParser's codes mean to the writer of a scene.
std::string message_of(const mu::ParserError& fault) {
  switch (fault.GetCode()) {
    case mu::ecUNEXPECTED_EOF:
    case mu::ecEMPTY_EXPRESSION: return "the expression ends too early";
    case mu::ecMISSING_PARENS: return "a closing parenthesis is missing";
    case mu::ecUNEXPECTED_PARENS: return "a parenthesis is not expected here";
    case mu::ecUNEXPECTED_OPERATOR: return "an operator is not expected here";
    case mu::ecUNEXPECTED_ARG_SEP: return "a comma is not expected here; decimals are written with a point";
    case mu::ecTOO_FEW_PARAMS: return "the function takes more arguments";
    case mu::ecTOO_MANY_PARAMS: return "the function takes fewer arguments";
    case mu::ecMISPLACED_COLON:
    case mu::ecMISSING_ELSE_CLAUSE: return "`?` and `:` do not belong together";
    case mu::ecEXPRESSION_TOO_LONG: return "the expression is too long";
    default: return "the expression cannot be understood here";
  }
}

std::size_t word_length(std::string_view text) {
  std::size_t n = 0;
  while (n < text.size() && (is_letter(text[n]) || (n > 0 && is_digit(text[n])))) ++n;
  return n;
}

std::size_t number_length(std::string_view text) {
  double value = 0.0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  return status == std::errc::invalid_argument ? 0 : static_cast<std::size_t>(end - text.data());
}

/// Calls visit(offset, word) for each word that is not the exponent of a number.
template <typename Visit>
void for_each_word(std::string_view text, Visit visit) {
  for (std::size_t i = 0; i < text.size();) {
    if (const std::size_t word = word_length(text.substr(i)); word > 0) {
      visit(i, text.substr(i, word));
      i += word;
    } else if (is_digit(text[i]) || text[i] == '.') {
      i += std::max<std::size_t>(1, number_length(text.substr(i)));
    } else {
      ++i;
    }
  }
}

std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

std::string unit_names() {
  std::string names;
  for (const Unit& unit : units) names.append(names.empty() ? "" : " ").append(unit.name);
  return names;
}

/// A unit that a number is divided by, as in "360 deg/s": units stand behind numbers only.
std::optional<ExpressionFault> find_divisor_unit(std::string_view text) {
  std::optional<ExpressionFault> fault;
  for_each_word(text, [&](std::size_t offset, std::string_view word) {
    std::string_view before = without_blanks(text.substr(0, offset));
    if (fault || find_unit(word) == nullptr || before.empty() || before.back() != '/') return;
    before = without_blanks(before.substr(0, before.size() - 1));
    const std::string unit(word);
    const bool rate = unit == "s" && !quantity_unit(before).empty();
    fault =
        ExpressionFault{Code::bad_expression, offset, word.size(), "the unit `" + unit + "` has no number before it",
                        rate ? "rates are per second already: write " + std::string(before)
                             : "a unit is written after a number: 1 " + unit};
  });
  return fault;
}

}  // namespace

struct Calculator::Impl {
  mu::Parser parser;
  std::set<std::string, std::less<>> names;

  Impl() {
    parser.ClearConst();
    parser.ClearFun();
    parser.DefineConst("pi", std::numbers::pi);
    for (const Unit& unit : units) parser.DefinePostfixOprt(unit.name, unit.to_si);
    for (const Function& function : functions) parser.DefineFun(function.name, function.of);
    parser.DefineFun("atan2", arc_tangent);
    parser.DefineFun("min", least);
    parser.DefineFun("max", greatest);
  }

  bool knows(std::string_view word) const { return !reserved_word(word).empty() || names.find(word) != names.end(); }

  std::vector<std::string> words() const {
    std::vector<std::string> all(names.begin(), names.end());
    for (const Unit& unit : units) all.emplace_back(unit.name);
    for (const Function& function : functions) all.emplace_back(function.name);
    for (const auto& name : functions_of_more) all.emplace_back(name);
    all.emplace_back("pi");
    return all;
  }
};

Calculator::Calculator() : impl_(std::make_unique<Impl>()) {}
Calculator::~Calculator() = default;
Calculator::Calculator(Calculator&&) noexcept = default;
Calculator& Calculator::operator=(Calculator&&) noexcept = default;

void Calculator::define(const std::string& name, double value) {
  try {
    impl_->parser.DefineConst(name, value);
    impl_->names.insert(name);
  } catch (const mu::ParserError&) {
    // Cannot happen for identifiers that are no reserved words; expressions with the name will say that it is unknown.
  }
}

tl::expected<double, ExpressionFault> Calculator::evaluate(const std::string& text) const {
  std::optional<ExpressionFault> unknown;
  for_each_word(text, [&](std::size_t offset, std::string_view word) {
    if (unknown || impl_->knows(word)) return;
    const std::string_view before = without_blanks(std::string_view(text).substr(0, offset));
    if (!before.empty() && (is_digit(before.back()) || before.back() == '.')) {
      unknown = ExpressionFault{Code::bad_expression, offset, word.size(),
                                std::string("`").append(word).append("` is no unit"), "units are " + unit_names()};
      return;
    }
    std::string message = '`' + std::string(word) + "` is neither a parameter nor a unit nor a function";
    const auto nearest = nearest_name(word, impl_->words());
    unknown = ExpressionFault{Code::bad_expression, offset, word.size(), std::move(message),
                              nearest ? "did you mean `" + *nearest + "`?"
                                      : std::string("define it in [parameters], or write a number with a unit")};
  });
  if (!unknown) unknown = find_divisor_unit(text);
  if (unknown) return tl::make_unexpected(std::move(*unknown));
  try {
    impl_->parser.SetExpr(text);
    const double value = impl_->parser.Eval();
    if (impl_->parser.GetNumResults() != 1) {
      return tl::make_unexpected(ExpressionFault{Code::bad_expression, 0, text.size(),
                                                 "the expression has several values",
                                                 "write decimals with a point, and lists in brackets"});
    }
    if (!std::isfinite(value)) {
      return tl::make_unexpected(
          ExpressionFault{Code::not_finite, 0, text.size(), "the expression has no finite value", ""});
    }
    return value;
  } catch (const mu::ParserError& fault) {
    // Positions point behind what was read last.
    const std::size_t position = std::min(text.size(), static_cast<std::size_t>(std::max(0, fault.GetPos())));
    return tl::make_unexpected(
        ExpressionFault{Code::bad_expression, position, 1, message_of(fault),
                        "a quantity is written \"30 deg\", an expression \"2*length*sin(30 deg)\""});
  } catch (const std::exception&) {
    return tl::make_unexpected(
        ExpressionFault{Code::bad_expression, 0, text.size(), "the expression cannot be computed", ""});
  }
}

std::vector<std::string> names_in(std::string_view expression) {
  std::vector<std::string> names;
  for_each_word(expression, [&](std::size_t, std::string_view word) { names.emplace_back(word); });
  return names;
}

bool is_parameter_name(std::string_view text) { return !text.empty() && word_length(text) == text.size(); }

std::string_view reserved_word(std::string_view word) {
  if (find_unit(word) != nullptr) return "a unit";
  if (word == "pi") return "a constant";
  const bool one =
      std::any_of(functions.begin(), functions.end(), [word](const Function& f) { return word == f.name; });
  const bool more = std::find(functions_of_more.begin(), functions_of_more.end(), word) != functions_of_more.end();
  return one || more ? "a function" : "";
}

std::string_view quantity_unit(std::string_view text) {
  text = without_blanks(text);
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) text = without_blanks(text.substr(1));
  if (text.empty() || !(is_digit(text.front()) || text.front() == '.')) return {};
  const Unit* unit = find_unit(without_blanks(text.substr(number_length(text))));
  return unit == nullptr ? std::string_view{} : unit->si;
}

}  // namespace koppel
