// A checked view of one table: which keys it must and may have, and that it has no others.
#pragma once

#include <initializer_list>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "scene/value_reader.hpp"

namespace koppel {

/// Borrows the table.
class TableReader {
 public:
  TableReader(const Node& table, ValueReader values) : table_(&table), values_(std::move(values)) {}

  const ValueReader& values() const { return values_; }
  const Reporter& report() const { return values_.report(); }
  const Place& place() const { return table_->place; }

  /// The value of a key, null if it is not there. The key counts as known.
  const Node* find(std::string_view key);
  /// The same for a key that must be there. Error: missing_key.
  const Node* require(std::string_view key, std::string_view advice);
  /// The text of a key that must be there.
  std::optional<std::string> require_text(std::string_view key, std::string_view advice);
  /// At most one of the keys is there. Error: conflicting_keys, at the second one. All count as known.
  bool at_most_one(std::initializer_list<std::string_view> keys);
  /// None of the keys is there. Error: conflicting_keys, with the reason. All count as known.
  bool none_of(std::initializer_list<std::string_view> keys, std::string_view reason);
  /// Where a key stands; the table itself if it does not.
  const Place& place_of(std::string_view key) const;
  /// Reports the keys that nobody has asked for.
  void finish() const;
  /// The same where the type is faulty: other keys may be its parameters, so that only misspelt ones are reported.
  /// `more`: keys of the language that nobody has asked for yet.
  void finish_without_type(std::initializer_list<std::string_view> more = {});

 private:
  const Node* table_;
  ValueReader values_;
  std::set<std::string, std::less<>> known_;
};

}  // namespace koppel
