// stream_source URL COUNT PAUSE: streams COUNT snapshots, PAUSE milliseconds apart, with an event after every tenth,
// and prints what a listener must find, one line for each message, doubles as hexadecimal numbers.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "example.hpp"

namespace {

using koppel::test::Numbers;

template <typename Range>
void print(const Range& numbers) {
  for (const double number : numbers) std::printf(" %a", number);
}

void print(int n, const Numbers& numbers) {
  std::printf("state %d %a", n, numbers.time);
  print(numbers.q);
  print(numbers.v);
  print(numbers.a);
  std::printf("\npositions %d", n);
  for (std::size_t body = 0; body < 2; ++body) print(std::span(numbers.poses).subspan(12 * body + 9, 3));
  std::printf("\nrotations %d", n);
  for (std::size_t body = 0; body < 2; ++body) print(std::span(numbers.poses).subspan(12 * body, 9));
  const koppel::ClosureFigures& c = numbers.closure;
  std::printf("\nclosure %d %d %d %d %u %u %u %u %a %a %a\n", n, c.verdict, c.solver, c.status, c.iterations, c.rank,
              c.equations, c.unknowns, c.residual, c.condition, c.coordinate_error);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: stream_source URL COUNT PAUSE\n");
    return 2;
  }
  koppel::StreamOptions options;
  options.url = argv[1];
  auto publisher = koppel::Publisher::open(koppel::test::example_model(), options, koppel::silent_logger());
  if (!publisher) {
    std::fputs(koppel::render(publisher.error()).c_str(), stderr);
    return 1;
  }
  for (int n = 0; n < std::atoi(argv[2]); ++n) {
    const Numbers numbers(n);
    if (!(*publisher)->publish(numbers.snapshot())) return 1;
    print(n, numbers);
    if (n % 10 == 9) {
      const std::string text = "tenth \xc3\xa4 " + std::to_string(n);
      if (!(*publisher)->event(numbers.time, koppel::Severity::warning, text)) return 1;
      std::printf("event %d %a 1 %s\n", n / 10, numbers.time, text.c_str());
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(std::atoi(argv[3])));
  }
  return (*publisher)->close() ? 0 : 1;
}
