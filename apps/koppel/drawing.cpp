#include "koppel/drawing.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <optional>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace koppel::app {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

Exit failed(const std::string& message) {
  std::fprintf(stderr, "error: %s\n", message.c_str());
  return Exit::system;
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// A file without a name, which is gone when it is closed, holding a text.
File scratch(const std::string& text) {
  File file(std::tmpfile());
  if (file == nullptr) return file;
  const bool good = std::fwrite(text.data(), 1, text.size(), file.get()) == text.size();
  if (!good || std::fflush(file.get()) != 0 || std::fseek(file.get(), 0, SEEK_SET) != 0) return nullptr;
  return file;
}

/// Starts `dot` from one file into another. 0: it ran to its end and was content; else errno, or -1.
int run_dot(std::FILE* from, std::FILE* to) {
  posix_spawn_file_actions_t actions;
  if (const int error = posix_spawn_file_actions_init(&actions)) return error;
  posix_spawn_file_actions_adddup2(&actions, fileno(from), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, fileno(to), STDOUT_FILENO);
  std::string program = "dot", format = "-Tsvg";
  char* const arguments[] = {program.data(), format.data(), nullptr};
  pid_t child = 0;
  const int error = posix_spawnp(&child, "dot", &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return error;
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return errno;
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? 0 : -1;
}

std::string content_of(std::FILE* file) {
  std::string text;
  std::rewind(file);
  char part[4096];
  while (const std::size_t n = std::fread(part, 1, sizeof part, file)) text.append(part, n);
  return text;
}

}  // namespace

std::string drawing_file(const std::string& file) {
  return ends_with(file, ".svg") || ends_with(file, ".dot") ? "" : "must be the name of an .svg or a .dot file";
}

Exit write_drawing(const std::string& dot, const std::string& file) {
  std::string content = dot;
  if (ends_with(file, ".svg")) {
    // Files instead of pipes: neither program can wait for the other.
    const File from = scratch(dot), to = scratch("");
    if (from == nullptr || to == nullptr) return failed("cannot make a temporary file");
    const int error = run_dot(from.get(), to.get());
    if (error == ENOENT) {
      return failed(
          "the program `dot` is not installed, which draws the diagram (Debian's package graphviz)\n"
          "  help: install it, or write FILE.dot, which needs nothing");
    }
    if (error != 0)
      return failed(std::string("`dot` failed") + (error > 0 ? std::string(": ") + std::strerror(error) : ""));
    content = content_of(to.get());
  }
  std::ofstream out(file, std::ios::binary);
  out << content;
  return out.flush().good() ? Exit::fine : failed("cannot write " + file);
}

}  // namespace koppel::app
