#include "scene/toml_text.hpp"

#include <algorithm>
#include <exception>
#include <optional>

#include <toml++/toml.h>

namespace koppel {
namespace {

// Each dotted key nests tables, and the library nests calls for each table when it frees them.
constexpr int most_dots_in_a_key = 32;
// What a scene needs is 4.
constexpr int most_levels = 64;

bool is_key_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
         c == '"' || c == '\'';
}

/// Where a key has too many dots, or npos. Knows nothing of strings and comments: those with so many dots between words
/// and none of the characters that end a key are refused as well.
std::size_t find_endless_key(std::string_view text) {
  int dots = 0;
  bool after_key = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '.') {
      if (after_key && ++dots > most_dots_in_a_key) return i;
      after_key = false;
    } else if (is_key_character(c)) {
      after_key = true;
    } else if (std::string_view("\n,=[]{}#").find(c) != std::string_view::npos) {
      dots = 0;
      after_key = false;
    }
  }
  return std::string_view::npos;
}

Node::Kind kind_of(toml::node_type type) {
  switch (type) {
    case toml::node_type::table: return Node::Kind::table;
    case toml::node_type::array: return Node::Kind::list;
    case toml::node_type::string: return Node::Kind::string;
    case toml::node_type::integer: return Node::Kind::integer;
    case toml::node_type::floating_point: return Node::Kind::real;
    case toml::node_type::boolean: return Node::Kind::boolean;
    case toml::node_type::none:
    case toml::node_type::date:
    case toml::node_type::time:
    case toml::node_type::date_time: return Node::Kind::date;
  }
  return Node::Kind::date;
}

/// Bytes that the first `count` characters of a UTF-8 text take.
std::size_t bytes_of(std::string_view text, std::size_t count) {
  std::size_t i = 0;
  for (; count > 0 && i < text.size(); --count) {
    ++i;
    while (i < text.size() && (static_cast<unsigned char>(text[i]) & 0xC0u) == 0x80u) ++i;
  }
  return i;
}

}  // namespace

/// Turns the library's tree into ours; its columns count characters, ours bytes.
struct TomlConversion {
  const Document& document;
  std::optional<Place> too_deep;  ///< where the text is nested more deeply than any scene

  Place place(const toml::source_region& region) const {
    const auto line = static_cast<int>(region.begin.line);
    const std::string_view text = document.line(line);
    const std::size_t begin = bytes_of(text, region.begin.column > 0 ? region.begin.column - 1 : 0);
    std::size_t end = text.size();
    if (region.end.line == region.begin.line) end = bytes_of(text, region.end.column > 0 ? region.end.column - 1 : 0);
    return {line, static_cast<int>(begin) + 1, static_cast<int>(std::max(end, begin) - begin)};
  }

  Node node(const toml::node& from, int level = 0) {
    Node to;
    to.kind = kind_of(from.type());
    to.place = place(from.source());
    if (level > most_levels) {
      too_deep = to.place;
      return to;
    }
    if (const auto* boolean = from.as_boolean()) to.truth = boolean->get();
    if (const auto* integer = from.as_integer()) to.number = static_cast<double>(integer->get());
    if (const auto* real = from.as_floating_point()) to.number = real->get();
    if (const auto* string = from.as_string()) to.text = string->get();
    if (const auto* list = from.as_array()) {
      to.items.reserve(list->size());
      for (const toml::node& item : *list) to.items.push_back(node(item, level + 1));
    }
    if (const auto* table = from.as_table()) fill_table(*table, to, level);
    return to;
  }

 private:
  void fill_table(const toml::table& from, Node& to, int level) {
    using Entry = std::pair<const toml::key*, const toml::node*>;
    std::vector<Entry> entries;
    entries.reserve(from.size());
    for (const auto& [key, value] : from) entries.emplace_back(&key, &value);
    // The library sorts by name; people read by place.
    std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
      const auto& p = a.first->source().begin;
      const auto& q = b.first->source().begin;
      return p.line != q.line ? p.line < q.line : p.column < q.column;
    });
    for (const auto& [key, value] : entries) {
      to.keys.push_back({std::string(key->str()), place(key->source())});
      to.items.push_back(node(*value, level + 1));
    }
  }
};

const Node* Node::find(std::string_view key) const {
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (keys[i].text == key) return &items[i];
  }
  return nullptr;
}

std::string_view kind_name(Node::Kind kind) {
  switch (kind) {
    case Node::Kind::boolean: return "a boolean";
    case Node::Kind::integer:
    case Node::Kind::real: return "a number";
    case Node::Kind::string: return "a string";
    case Node::Kind::list: return "a list";
    case Node::Kind::table: return "a table";
    case Node::Kind::date: return "a date or time";
  }
  return "a value";
}

Document::Document(std::string text, std::string name) : text_(std::move(text)), name_(std::move(name)) {
  line_starts_.push_back(0);
  for (std::size_t i = 0; i < text_.size(); ++i) {
    if (text_[i] == '\n') line_starts_.push_back(i + 1);
  }
}

Result<std::unique_ptr<Document>> Document::parse(std::string text, std::string name) {
  std::unique_ptr<Document> document(new Document(std::move(text), std::move(name)));
  const std::string_view view = document->text_;
  const auto nested = [&document](const Place& place) {
    return tl::make_unexpected(Error{Code::toml_syntax, Severity::error, document->source(place), "",
                                     "the text is nested more deeply than any scene", "use fewer dots and brackets"});
  };
  if (const std::size_t at = find_endless_key(view); at != std::string_view::npos) {
    const auto& starts = document->line_starts_;
    const auto line = std::upper_bound(starts.begin(), starts.end(), at) - starts.begin();
    const std::size_t column = at - starts[static_cast<std::size_t>(line) - 1] + 1;
    return nested({static_cast<int>(line), static_cast<int>(column), 1});
  }
  try {
    TomlConversion conversion{*document, {}};
    document->root_ = conversion.node(toml::parse(view, document->name_));
    if (conversion.too_deep) return nested(*conversion.too_deep);
  } catch (const toml::parse_error& fault) {
    Place place = TomlConversion{*document, {}}.place(fault.source());
    place.length = 1;
    return tl::make_unexpected(
        Error{Code::toml_syntax, Severity::error, document->source(place), "", std::string(fault.description()), ""});
  } catch (const std::exception& fault) {
    return tl::make_unexpected(Error{Code::toml_syntax, Severity::error, document->source({}), "", fault.what(), ""});
  }
  return document;
}

std::string_view Document::line(int number) const {
  if (number < 1 || static_cast<std::size_t>(number) > line_starts_.size()) return {};
  const auto index = static_cast<std::size_t>(number) - 1;
  const std::size_t begin = line_starts_[index];
  std::size_t end = index + 1 < line_starts_.size() ? line_starts_[index + 1] - 1 : text_.size();
  if (end > begin && text_[end - 1] == '\r') --end;
  return std::string_view(text_).substr(begin, end - begin);
}

Source Document::source(const Place& place) const {
  return {name_, std::string(line(place.line)), place.line, place.column, place.length};
}

Place Document::within(const Node& string, std::size_t offset, std::size_t length) const {
  const Place& whole = string.place;
  const std::string_view text = line(whole.line);
  const auto begin = static_cast<std::size_t>(whole.column);
  if (begin > text.size() || text.substr(begin, string.text.size()) != string.text) return whole;
  offset = std::min(offset, string.text.size());
  length = std::max<std::size_t>(1, std::min(length, string.text.size() - offset));
  return {whole.line, whole.column + 1 + static_cast<int>(offset), static_cast<int>(length)};
}

}  // namespace koppel
