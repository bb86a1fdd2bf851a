// The tables of the explicit Runge-Kutta methods but the largest.
#include "dynamics/runge_kutta.hpp"

namespace koppel {
namespace {

using Stage = RungeKuttaTable::Stage;
using Weights = RungeKuttaTable::Weights;

// Dormand and Prince (1980), table II.5.2 of the book; between the ends to order 4 (II.6, Shampine 1986).
constexpr std::array<Stage, 7> dormand_prince_stages{{
    {0, {}},
    {1.0 / 5, {1.0 / 5}},
    {3.0 / 10, {3.0 / 40, 9.0 / 40}},
    {4.0 / 5, {44.0 / 45, -56.0 / 15, 32.0 / 9}},
    {8.0 / 9, {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729}},
    {1, {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656}},
    {1, {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}},
}};
constexpr std::array<Weights, 1> dormand_prince_errors{
    {{71.0 / 57600, 0, -71.0 / 16695, 71.0 / 1920, -17253.0 / 339200, 22.0 / 525, -1.0 / 40}}};
constexpr std::array<Weights, 1> dormand_prince_polynomial{
    {{-12715105075.0 / 11282082432, 0, 87487479700.0 / 32700410799, -10690763975.0 / 1880347072,
      701980252875.0 / 199316789632, -1453857185.0 / 822651844, 69997945.0 / 29380423}}};
constexpr RungeKuttaTable dormand_prince{
    dormand_prince_stages, {}, dormand_prince_errors, dormand_prince_polynomial, 5, 0.17, 0.04, 0.2, 10, 3.25};

constexpr std::array<Stage, 5> classical_stages{{
    {0, {}},
    {0.5, {0.5}},
    {0.5, {0, 0.5}},
    {1, {0, 0, 1}},
    {1, {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6}},
}};
constexpr RungeKuttaTable classical{classical_stages, {}, {}, {}, 4, 0, 0, 1, 1, 2.785};

}  // namespace

DormandPrince::DormandPrince(DifferentialEquation& problem, double tolerance, double first_step)
    : RungeKutta(dormand_prince, problem, tolerance, first_step) {}

ClassicalRungeKutta::ClassicalRungeKutta(DifferentialEquation& problem, double, double step)
    : RungeKutta(classical, problem, 0.0, step) {}

}  // namespace koppel
