#include "scene/table_reader.hpp"

#include <functional>

namespace koppel {

const Node* TableReader::find(std::string_view key) {
  known_.emplace(key);
  return table_->find(key);
}

const Node* TableReader::require(std::string_view key, std::string_view advice) {
  const Node* node = find(key);
  if (node == nullptr) {
    report().error(Code::missing_key, table_->place, quote(key) + " is missing", std::string(advice));
  }
  return node;
}

std::optional<std::string> TableReader::require_text(std::string_view key, std::string_view advice) {
  const Node* node = require(key, advice);
  if (node == nullptr) return std::nullopt;
  return values_.text(*node, quote(key));
}

bool TableReader::at_most_one(std::initializer_list<std::string_view> keys) {
  std::string_view first;
  bool single = true;
  for (const std::string_view key : keys) {
    if (find(key) == nullptr) continue;
    if (!first.empty()) {
      report().error(Code::conflicting_keys, place_of(key), quote(key) + " and " + quote(first) + " say the same thing",
                     "keep one of them");
      single = false;
    } else {
      first = key;
    }
  }
  return single;
}

bool TableReader::none_of(std::initializer_list<std::string_view> keys, std::string_view reason) {
  bool none = true;
  for (const std::string_view key : keys) {
    if (find(key) == nullptr) continue;
    report().error(Code::conflicting_keys, place_of(key), quote(key) + ' ' + std::string(reason),
                   "remove " + quote(key));
    none = false;
  }
  return none;
}

const Place& TableReader::place_of(std::string_view key) const {
  for (const Node::Key& k : table_->keys) {
    if (k.text == key) return k.place;
  }
  return table_->place;
}

void TableReader::finish() const {
  const std::vector<std::string> candidates(known_.begin(), known_.end());
  for (const Node::Key& key : table_->keys) {
    if (known_.count(key.text) > 0) continue;
    std::string advice = did_you_mean(key.text, candidates);
    if (advice.empty()) {
      for (const std::string& known : candidates) advice += (advice.empty() ? "known here: " : ", ") + known;
    }
    report().error(Code::unknown_key, key.place, quote(key.text) + " is not known here", std::move(advice));
  }
}

void TableReader::finish_without_type(std::initializer_list<std::string_view> more) {
  for (const std::string_view key : more) known_.emplace(key);
  const std::vector<std::string> candidates(known_.begin(), known_.end());
  for (const Node::Key& key : table_->keys) {
    if (known_.count(key.text) > 0) continue;
    // `axis2` is no misspelt `axis`.
    if (!key.text.empty() && key.text.back() >= '0' && key.text.back() <= '9') continue;
    std::string advice = did_you_mean(key.text, candidates);
    if (advice.empty()) continue;
    report().error(Code::unknown_key, key.place, quote(key.text) + " is not known here", std::move(advice));
  }
}

}  // namespace koppel
