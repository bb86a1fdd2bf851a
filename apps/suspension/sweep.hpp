// Moves a suspension through its travel, row by row.
#pragma once

#include <string>
#include <vector>

#include "common/model.hpp"
#include "suspension/wheel.hpp"

namespace koppel::app {

struct SweepOptions {
  std::string input = "wheel.z";       ///< the driven coordinate that lifts the wheel
  std::string frame = "wheel_centre";  ///< origin: wheel centre, y axis: axis of rotation, towards the left
  double travel = 0.08;                ///< [m] up and down from the design position
  double spacing = 0.01;               ///< [m] between rows
  double radius = 0.0;                 ///< [m] of the tyre
};

/// One row of the table.
struct Row {
  double travel = 0.0;  ///< [m]
  Wheel wheel;
  koppel_report report = sized<koppel_report>();
  double seconds = 0.0;       ///< median for position, velocity and acceleration, from the row before
  std::vector<double> poses;  ///< 12 numbers for each named frame
};

struct SweepResult {
  std::vector<Row> rows;   ///< from the lowest to the highest
  std::size_t design = 0;  ///< the row of travel 0
  double side = 1.0;       ///< +1: a left wheel
  double speed = 0.0;      ///< [m/s] of the travel, to which the rates in the rows belong
  Exit outcome = Exit::fine;
  koppel_error error = sized<koppel_error>();  ///< where the outcome is not fine
};

/// Closes the suspension at the design position, lowers it to the end and lifts it through all rows. stream: may be
/// null; gets every position.
SweepResult sweep(const Model& model, const SweepOptions& options, koppel_stream* stream);

}  // namespace koppel::app
