// The table [parameters] of one file, and the expressions that use it.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "scene/expression.hpp"
#include "scene/findings.hpp"
#include "scene/toml_text.hpp"

namespace koppel {

/// Values that an including scene sets. Nothing: its expression was faulty, which has been reported.
using ParameterOverrides = std::map<std::string, std::optional<double>>;

class SceneParameters {
 public:
  /// Computes all parameters of a table (null: there is none), whatever their order. Reports faults and cycles.
  void read(const Node* table, const ParameterOverrides& overrides, const Reporter& report);

  /// The value of an expression. Nothing after a fault: reported here, or earlier where a parameter is faulty.
  std::optional<double> evaluate(const Node& string, const Reporter& report);

  std::vector<std::string> names() const;
  /// Warns of parameters that no expression has used, and that no including scene sets.
  void report_unused(const Reporter& report) const;

 private:
  struct Definition {
    const Node* value = nullptr;
    Place place;
    std::set<std::string> needs;     ///< parameters in its expression
    std::vector<std::string> users;  ///< parameters that need it
    bool overridden = false;
    bool usable = false;  ///< has a value
    bool used = false;
  };

  void collect(const Node& table, const ParameterOverrides& overrides, const Reporter& report);
  void connect();
  void compute(Definition& definition, const std::string& name, const ParameterOverrides& overrides,
               const Reporter& report);
  void report_cycles(const std::map<std::string, std::size_t>& open, const Reporter& report) const;

  std::map<std::string, Definition> definitions_;
  std::set<std::string> refused_;  ///< words of faulty names: expressions that fail with them say nothing more
  Calculator calculator_;
};

}  // namespace koppel
