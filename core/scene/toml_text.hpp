// A TOML document as a tree that remembers where each key and value stands. The only header that stands between the
// TOML library and the rest of the room.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"

namespace koppel {

/// Where something stands in a document: line and column from 1, column and length in bytes.
struct Place {
  int line = 0;
  int column = 0;
  int length = 0;
};

/// A value of a document. Lists have `items`; tables have `keys`, in the order of the text, with one item each.
struct Node {
  enum class Kind { boolean, integer, real, string, list, table, date };
  struct Key {
    std::string text;
    Place place;
  };

  Kind kind = Kind::table;
  Place place;  ///< of a [[table]]: its header
  bool truth = false;
  double number = 0.0;  ///< of integers and reals; may be infinite or not a number
  std::string text;
  std::vector<Node> items;
  std::vector<Key> keys;

  bool is_number() const { return kind == Kind::integer || kind == Kind::real; }
  bool is_string() const { return kind == Kind::string; }
  bool is_list() const { return kind == Kind::list; }
  bool is_table() const { return kind == Kind::table; }
  /// The value of a key, null if there is none.
  const Node* find(std::string_view key) const;
};

/// "a number", "a list", ... for messages.
std::string_view kind_name(Node::Kind kind);

class Document {
 public:
  /// `name`: what findings call the file. Error: toml_syntax.
  static Result<std::unique_ptr<Document>> parse(std::string text, std::string name);

  const std::string& name() const { return name_; }
  const Node& root() const { return root_; }
  Source source(const Place& place) const;
  /// The place of a part of a string value; the whole value where escapes make that uncertain.
  Place within(const Node& string, std::size_t offset, std::size_t length) const;

 private:
  Document(std::string text, std::string name);
  std::string_view line(int number) const;

  friend struct TomlConversion;
  std::string text_;
  std::string name_;
  std::vector<std::size_t> line_starts_;
  Node root_;
};

}  // namespace koppel
