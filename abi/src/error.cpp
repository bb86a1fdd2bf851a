#include "base/error.hpp"

#include "boundary.hpp"

namespace koppel {
namespace {

template <std::size_t N>
void copy_text(std::string_view from, char (&to)[N]) {
  std::size_t n = std::min(from.size(), N - 1);
  // Cut between characters, never inside one.
  while (n > 0 && n < from.size() && (static_cast<unsigned char>(from[n]) & 0xC0u) == 0x80u) --n;
  from.copy(to, n);  // unlike memcpy, allows an empty text that points nowhere
  to[n] = '\0';
}

}  // namespace

koppel_status status_of(Code code) {
  const int number = static_cast<int>(code);
  switch (number / 100) {
    case 1: return code == Code::file_unreadable ? KOPPEL_IO : KOPPEL_INVALID_SCENE;
    case 2:
    case 3:
    case 4: return KOPPEL_INVALID_SCENE;
    case 5: return code == Code::plugin_version ? KOPPEL_VERSION : KOPPEL_PLUGIN;
    case 6: return KOPPEL_INVALID_SCENE;
    case 7: return code == Code::inputs_inconsistent ? KOPPEL_SINGULAR : KOPPEL_NOT_CLOSED;
    case 8: return code == Code::stream_failed ? KOPPEL_IO : KOPPEL_INVALID_ARGUMENT;
    case 10: return code == Code::simulation_stuck ? KOPPEL_NOT_CLOSED : KOPPEL_SINGULAR;
    case 11: return code == Code::no_equilibrium ? KOPPEL_NOT_CLOSED : KOPPEL_SINGULAR;
    default: break;
  }
  if (code == Code::library_version) return KOPPEL_VERSION;
  if (code == Code::out_of_memory) return KOPPEL_NO_MEMORY;
  return code == Code::invalid_argument ? KOPPEL_INVALID_ARGUMENT : KOPPEL_INTERNAL;
}

koppel_status fail(koppel_status status, const Error& error, koppel_error* out) {
  if (out == nullptr) return status;
  koppel_error e{};
  e.status = status;
  e.severity = static_cast<std::int32_t>(error.severity);
  e.line = error.source.line;
  e.column = error.source.column;
  e.length = error.source.length;
  copy_text(code_text(error.code, error.severity), e.code);
  copy_text(error.source.file, e.file);
  copy_text(error.source.line_text, e.source_line);
  copy_text(error.element, e.element);
  copy_text(error.message, e.message);
  copy_text(error.advice, e.advice);
  write_struct(e, out);
  return status;
}

koppel_status fail(const Error& error, koppel_error* out) { return fail(status_of(error.code), error, out); }

koppel_status invalid_argument(std::string message, koppel_error* out) {
  return fail(make_error(Code::invalid_argument, {}, std::move(message)), out);
}

koppel_status fail_without_memory(koppel_error* out, koppel_status status, const char* code,
                                  const char* message) noexcept {
  if (out == nullptr) return status;
  koppel_error e{};
  e.status = status;
  e.severity = KOPPEL_SEVERITY_ERROR;
  copy_text(code, e.code);
  copy_text(message, e.message);
  write_struct(e, out);
  return status;
}

koppel_status write_text(std::string_view text, char* buffer, std::size_t size, std::size_t* needed) {
  if (buffer == nullptr ? needed == nullptr : size == 0) return KOPPEL_INVALID_ARGUMENT;
  if (needed != nullptr) *needed = text.size() + 1;
  if (buffer == nullptr) return KOPPEL_OK;
  const std::size_t n = std::min(text.size(), size - 1);
  text.copy(buffer, n);
  buffer[n] = '\0';
  return KOPPEL_OK;
}

}  // namespace koppel

koppel_status koppel_explain_code(const char* code, char* text, size_t size, size_t* needed) {
  return koppel::guarded(nullptr, [&]() -> koppel_status {
    if (code == nullptr) return KOPPEL_INVALID_ARGUMENT;
    const auto explanation = koppel::explain_code(code);
    return explanation ? koppel::write_text(*explanation, text, size, needed) : KOPPEL_INVALID_ARGUMENT;
  });
}
