// Properties of closure on mechanisms drawn at random, of which one closed position is known.
//
//   KOPPEL_RANDOM_MECHANISMS=100000   how many (default: 75)
//   KOPPEL_RANDOM_FIRST=1             the seed of the first; each mechanism has the next number
//   KOPPEL_RANDOM_SEED=1234           this one alone, with its scene
//   KOPPEL_RANDOM_MODES=8             of which share all modes are searched: every 8th; 0: of none
#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "closure/decompositions.hpp"
#include "closure/modes.hpp"
#include "random_mechanism_maker.hpp"
#include "random_mechanism_positions.hpp"
#include "random_mechanism_table.hpp"

namespace koppel::test {
namespace {

using Table = RandomMechanismTable;

unsigned number_from(const char* variable, unsigned otherwise) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? otherwise : static_cast<unsigned>(std::strtoul(text, nullptr, 10));
}

constexpr int paths_for_modes = 2000;  ///< then the search ends without an answer

/// One mechanism and all that is asked of it.
class Trial {
 public:
  Trial(unsigned seed, Table& table)
      : seed_(seed),
        table_(table),
        random_(seed + 0x9e3779b9u),
        drawn_(MechanismMaker(seed).make()),
        closed_(drawn_.text(), types_of_random_mechanisms()),
        at_(drawn_, *closed_.built.mechanism) {
    ++table_.cases[static_cast<std::size_t>(drawn_.special)];
  }

  void run(bool with_modes) {
    if (drawn_.special != Special::too_long) {
      look_at_known_position();
      from_near();
      from_very_near();
    }
    from_afar();
    if (with_modes && drawn_.loops() <= 3 && all_products()) modes();
  }

  std::string scene(const Eigen::VectorXd* start = nullptr) const { return drawn_.text(&*mechanism(), start); }

 private:
  const Mechanism* mechanism() const { return closed_.built.mechanism.get(); }
  bool all_products() const {
    return std::all_of(mechanism()->joints.begin(), mechanism()->joints.end(),
                       [](const Joint& joint) { return joint.is_product(); });
  }

  void add(Table::Column column, bool well) { table_.add(drawn_.special, column, well); }

  void fail(const std::string& what, const std::string& details, const Eigen::VectorXd& start) {
    const std::size_t before = table_.failures[what]++;
    auto failure = ::testing::Message() << what << ", KOPPEL_RANDOM_SEED=" << seed_ << " ("
                                        << special_names[static_cast<std::size_t>(drawn_.special)] << "): " << details;
    if (before < 3) failure << "\n" << scene(&start);
    ADD_FAILURE() << failure;
  }

  // ---------------------------------------------------------------- the known position

  struct SingularValues {
    Eigen::Index rank = 0;
    double greatest = 0.0, smallest = 1.0, next = 0.0;
  };

  SingularValues singular_values(const Eigen::VectorXd& q) {
    Equations equations(*mechanism());
    EXPECT_TRUE(equations.evaluate(q, 0.0));
    equations.evaluate_jacobian();
    known_residual_ = equations.error();
    SingularValues result;
    if (mechanism()->unknowns == 0 || mechanism()->rows == 0) return result;
    const Eigen::MatrixXd of_unknowns = equations.jacobian.leftCols(mechanism()->unknowns);
    const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(of_unknowns).singularValues();
    while (result.rank < values.size() && values[result.rank] > 1e-9 * values[0]) ++result.rank;
    result.greatest = values[0];
    result.smallest = result.rank > 0 ? values[result.rank - 1] : 1.0;
    result.next = result.rank < values.size() ? values[result.rank] : 0.0;
    return result;
  }

  /// The known position is a closed one; is it one that neighbours tell from a singular one?
  void look_at_known_position() {
    const SingularValues near_by = singular_values(at_.displaced(drawn_.known, 1e-3, random_));
    at_known_ = singular_values(drawn_.known);
    if (!(at_.open(drawn_.known) <= 1e-11)) fail("the known position is not closed", "", drawn_.known);
    if (!(known_residual_ <= 1e-8)) {
      fail("the equations do not hold at the known position", std::to_string(known_residual_), drawn_.known);
    }
    regular_ =
        at_known_.rank == near_by.rank && at_known_.smallest > 1e-5 && at_known_.next < 1e-11 && near_by.next < 1e-13;
  }

  // ---------------------------------------------------------------- closing

  struct Closure {
    Eigen::VectorXd q;
    Report report;
    bool closed = false;
  };

  /// Closes from a position and checks whatever must be true of the answer.
  Closure close_from(const Eigen::VectorXd& start) {
    State state(*mechanism());
    state.q = start;
    const State before = state;
    Closure result;
    const koppel_status status = close(closed_.work, state, {}, result.report);
    result.closed = status >= 0;
    result.q = state.q;
    if (result.report.verdict == Verdict::unreachable) {
      ++table_.unreachable[static_cast<std::size_t>(drawn_.special)];
      if (drawn_.special != Special::too_long) fail("called unreachable, though a position is known", "", start);
    }
    if (!result.closed) {
      if (status != KOPPEL_NOT_CLOSED && status != KOPPEL_RETRY) {
        fail("an unexpected status", std::to_string(status), start);
      }
      if (!same_bits(state, before)) fail("not closed, and the state is another", "", start);
      return result;
    }
    check_closed(state, result.report, start);
    if (seed_ % 16 == 0) {
      Work another(closed_.built.mechanism);
      State again = before;
      Report report;
      close(another, again, {}, report);
      if (!same_bits(again, state)) fail("closed twice from one start, with two results", "", start);
    }
    return result;
  }

  void check_closed(const State& state, const Report& report, const Eigen::VectorXd& start) {
    const double left = at_.open(state.q);
    table_.substituted.values.push_back(left);
    std::ostringstream numbers;
    numbers << "residual " << report.residual << ", by substitution " << left;
    if (!(report.residual <= 1e-10)) fail("closed with too great a residual", numbers.str(), start);
    if (!(left <= 1e-9)) fail("called closed, but open by substitution", numbers.str(), start);
    for (std::size_t i = 0; i < mechanism()->inputs.size(); ++i) {
      if (state.q[mechanism()->inputs[i].q] == state.input[static_cast<Eigen::Index>(i)]) continue;
      fail("closed with another input", mechanism()->inputs[i].name, start);
    }
    State again = state;
    Report second;
    if (close(closed_.work, again, {}, second) < 0) fail("closed, but not when closed again", "", start);
    if (!same_bits(again.q, state.q)) fail("closed again elsewhere", "", start);
    if (drawn_.special == Special::too_long) fail("closed, with a link that is too long", numbers.str(), start);
  }

  void from_near() {
    const Closure closure = close_from(at_.displaced(drawn_.known, 1e-3, random_));
    add(Table::near, closure.closed);
    if (!closure.closed) return;
    table_.near_residual.values.push_back(closure.report.residual);
    table_.near_iterations.values.push_back(closure.report.iterations);
    if (regular_ && drawn_.all_driven) add(Table::on_known, at_.between(closure.q, drawn_.known) < 1e-6);
  }

  /// So near that Newton's method cannot but find it (Kantorovich), unless the position is singular.
  void from_very_near() {
    if (!regular_) return;
    const double by = std::min(1e-3, 0.01 * at_known_.smallest);
    const Eigen::VectorXd start = at_.displaced(drawn_.known, by, random_);
    const Closure closure = close_from(start);
    add(Table::very_near, closure.closed);
    std::ostringstream numbers;
    numbers << "smallest singular value " << at_known_.smallest << ", displaced by " << by;
    if (!closure.closed) return fail("not closed from very near", numbers.str(), start);
    const double moved = at_.way(drawn_.known, closure.q);
    numbers << ", ended at " << moved;
    if (!drawn_.all_driven) {
      if (moved > by * (10.0 + 10.0 * at_known_.greatest / at_known_.smallest)) {
        fail("went further than need be", numbers.str(), start);
      }
      return;
    }
    table_.missed.values.push_back(moved * at_known_.smallest);
    const double rounding = 1e-15 * at_.extent(at_.poses(drawn_.known)) + known_residual_ + closure.report.residual;
    if (moved * at_known_.smallest > 100.0 * rounding) fail("missed the known position", numbers.str(), start);
  }

  void from_afar() {
    const Closure closure = close_from(at_.displaced(drawn_.known, 3.0, random_));
    add(drawn_.special == Special::too_long ? Table::refused : Table::from_afar,
        closure.closed != (drawn_.special == Special::too_long));
    (closure.closed ? table_.afar_iterations : table_.lost_iterations).values.push_back(closure.report.iterations);
    if (!closure.closed) return;
    table_.afar_residual.values.push_back(closure.report.residual);
    if (drawn_.all_driven) add(Table::afar_on_known, at_.between(closure.q, drawn_.known) < 1e-6);
    afar_ = closure.q;
  }

  // ---------------------------------------------------------------- all modes

  void modes() {
    State state(*mechanism());
    // What no drive determines stays as the state has it.
    state.q = drawn_.all_driven ? at_.displaced(drawn_.known, 3.0, random_) : drawn_.known;
    ModeOptions options;
    options.all_twins = true;
    options.most_steps = 1u << 14;
    int paths = 0;
    options.progress = [&](std::size_t, double) { return ++paths < paths_for_modes; };
    Modes found;
    if (!find_modes(closed_.work, state, options, found)) fail("a plugin failed in the search for modes", "", state.q);
    add(Table::complete, found.complete);
    for (const Mode& mode : found.modes) {
      const double left = at_.open(mode.q);
      if (!(left <= 1e-9)) fail("a mode that is open by substitution", std::to_string(left), state.q);
      if (drawn_.special == Special::too_long) fail("a mode with a link that is too long", "", state.q);
    }
    if (!found.complete || drawn_.special == Special::too_long) return;
    table_.mode_count.values.push_back(static_cast<double>(found.modes.size()));
    if (!regular_) return;
    const auto known = [&](const Eigen::VectorXd& q) {
      return std::any_of(found.modes.begin(), found.modes.end(),
                         [&](const Mode& mode) { return at_.between(q, mode.q) < 1e-6; });
    };
    const std::string count = std::to_string(found.modes.size()) + " modes, complete: " + found.why;
    if (!known(drawn_.known)) fail("the modes are complete without the known one", count, drawn_.known);
    if (drawn_.all_driven && afar_.size() > 0 && singular_values(afar_).smallest > 1e-5 && !known(afar_)) {
      fail("the modes are complete without another closed position", count, afar_);
    }
  }

  unsigned seed_;
  Table& table_;
  Random random_;
  RandomMechanism drawn_;
  Closed closed_;
  RandomPositions at_;
  SingularValues at_known_;
  bool regular_ = false;
  double known_residual_ = 0.0;
  Eigen::VectorXd afar_;  ///< a closed position that was found from afar
};

TEST(RandomMechanisms, CloseOrSayThatTheyDoNot) {
  const unsigned every = number_from("KOPPEL_RANDOM_MODES", 8);
  const unsigned single = number_from("KOPPEL_RANDOM_SEED", 0);
  const unsigned first = single != 0 ? single : number_from("KOPPEL_RANDOM_FIRST", 1);
  const unsigned count = single != 0 ? 1 : number_from("KOPPEL_RANDOM_MECHANISMS", 75);
  Table table;
  for (unsigned seed = first; seed < first + count; ++seed) {
    Trial trial(seed, table);
    if (single != 0) std::cout << trial.scene() << "\n";
    trial.run(single != 0 || (every != 0 && seed % every == 0));
  }
  table.print(std::cout);
}

}  // namespace
}  // namespace koppel::test
