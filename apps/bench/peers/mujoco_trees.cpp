// MuJoCo on open trees: the parts of its step that an algorithm needs, one after the other, as mj_forward calls them.
#include <memory>
#include <sstream>

#include "mujoco_model.hpp"
#include "trees.hpp"

namespace koppel::peer {
namespace {

template <std::size_t n>
std::string list(const std::array<double, n>& numbers) {
  std::ostringstream out;
  out.precision(17);
  for (const double x : numbers) out << x << ' ';
  return out.str();
}

std::string text_of(const Tree& tree) {
  std::ostringstream out;
  out.precision(17);
  out << "<mujoco><compiler angle=\"radian\" balanceinertia=\"false\"/><option gravity=\"" << list(tree.gravity)
      << "\"><flag contact=\"disable\"/></option><worldbody>";
  std::vector<int> open;  // from the root to the last link
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    const Link& link = tree.links[i];
    for (; (open.empty() ? -1 : open.back()) != link.parent; open.pop_back()) out << "</body>";
    out << "<body pos=\"" << list(link.place) << "\" quat=\"" << list(link.turn)
        << "\"><joint type=\"hinge\" axis=\"0 0 1\"/><inertial mass=\"" << link.mass << "\" pos=\"" << list(link.centre)
        << "\" fullinertia=\"" << list(link.inertia) << "\"/>";
    open.push_back(static_cast<int>(i));
  }
  for (std::size_t i = 0; i < open.size(); ++i) out << "</body>";
  out << "</worldbody></mujoco>";
  return out.str();
}

/// The links are in the order in which their bodies are opened: each one's branch is whole before the next begins.
class MujocoTree final : public TreeEngine {
 public:
  explicit MujocoTree(const Tree& tree)
      : model_(compile(text_of(tree))), data_(mj_makeData(model_.get())), states_(tree.states) {
    const std::size_t n = tree.links.size();
    numbers_.resize(n);
    mass_.resize(n * n);
  }

  void evaluate(Algorithm algorithm, std::size_t number) override {
    const TreeState& state = states_[number];
    const mjModel* const model = model_.get();
    mjData* const data = data_.get();
    mju_copy(data->qpos, state.q.data(), model->nq);
    mj_kinematics(model, data);
    if (algorithm == Algorithm::position) return;
    mj_comPos(model, data);
    if (algorithm != Algorithm::inverse_dynamics) mj_crb(model, data);
    if (algorithm == Algorithm::mass_matrix) return mj_fullM(model, mass_.data(), data->qM);
    mju_copy(data->qvel, state.v.data(), model->nv);
    mj_comVel(model, data);
    if (algorithm == Algorithm::inverse_dynamics) {
      mju_copy(data->qacc, state.a.data(), model->nv);
      return mj_rne(model, data, 1, numbers_.data());
    }
    mj_factorM(model, data);
    mj_rne(model, data, 0, numbers_.data());
    mju_sub(numbers_.data(), state.efforts.data(), numbers_.data(), model->nv);
    mj_solveM(model, data, numbers_.data(), numbers_.data(), 1);
  }

  std::vector<double> result(Algorithm algorithm) override {
    // Body 0 is the world.
    if (algorithm == Algorithm::position)
      return {data_->xpos + 3, data_->xpos + 3 * static_cast<std::ptrdiff_t>(model_->nbody)};
    return algorithm == Algorithm::mass_matrix ? mass_ : numbers_;
  }

 private:
  Model model_;
  Data data_;
  std::vector<TreeState> states_;
  std::vector<double> numbers_, mass_;
};

}  // namespace

std::unique_ptr<TreeEngine> make_tree(const Tree& tree) { return std::make_unique<MujocoTree>(tree); }

}  // namespace koppel::peer
