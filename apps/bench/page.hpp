// The document as a page to look at: curves and tables in one file that needs no other.
#pragma once

#include <string>
#include <vector>

#include "bench/plot.hpp"
#include "bench/tables.hpp"

namespace koppel::app::bench {

struct NamedChart {
  std::string name, section;
  Chart chart;
};
std::vector<NamedChart> charts(const Json& document);

std::string page(const Json& document);

/// The page's charts, each as an SVG of its own.
std::vector<File> plots(const Json& document);

}  // namespace koppel::app::bench
