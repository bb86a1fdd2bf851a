#include "dynamics/mass_matrix.hpp"

namespace koppel {

MassMatrix::MassMatrix(const TreeLayout& layout, const Inertias& inertias)
    : layout_(layout),
      inertias_(inertias),
      composites_(layout.mechanism().nodes),
      columns_(std::size_t{9} * layout.rates()) {}

void MassMatrix::compose(const Kinematics& kinematics) {
  for (const TreeLayout::Step& step : layout_.steps()) {
    CompositeInertia& composite = composites_[step.child];
    if (inertias_.has_mass[step.child]) {
      const PlainMatrix3 rotation(kinematics.poses[step.child].rotation);
      composite = CompositeInertia::of(inertias_.of_node[step.child], rotation);
    } else {
      composite = {};
    }
  }
  for (std::size_t i = layout_.steps().size(); i-- > 0;) {
    const TreeLayout::Step& step = layout_.steps()[i];
    if (step.parent == 0) continue;
    const Plain3 arm = Plain3(kinematics.poses[step.child].position) - Plain3(kinematics.poses[step.parent].position);
    composites_[step.parent].add(composites_[step.child], arm);
  }
}

void MassMatrix::spread_columns(const Kinematics& kinematics) {
  const std::uint32_t n = layout_.rates();
  for (std::uint32_t p = 0; p < n; ++p) {
    const Column& column = kinematics.columns[layout_.rate(p)];
    double* to = columns_.data() + p;
    for (const Vector3* part : {&column.angular, &column.linear, &column.point}) {
      for (int i = 0; i < 3; ++i, to += n) *to = (*part)[i];
    }
  }
}

void MassMatrix::fill_row(std::uint32_t p, const Plain3& origin, const PlainWrench& momentum, double* row) const {
  const Plain3 &m = momentum.moment, &f = momentum.force;
  const std::size_t n = layout_.rates();
  for (const TreeLayout::Run& run : layout_.ancestors(p)) {
    const double* const a = columns_.data() + run.first;
    const double *const l = a + 3 * n, *const at = a + 6 * n;
    double* __restrict const out = row + run.depth;
    for (std::uint32_t k = 0; k < run.count; ++k) {
      // The moment about the ancestor's point, from the arm to it.
      const double x = origin.x - at[k], y = origin.y - at[n + k], z = origin.z - at[2 * n + k];
      out[k] = a[k] * (m.x + y * f.z - z * f.y) + a[n + k] * (m.y + z * f.x - x * f.z) +
               a[2 * n + k] * (m.z + x * f.y - y * f.x) + l[k] * f.x + l[n + k] * f.y + l[2 * n + k] * f.z;
    }
  }
}

void MassMatrix::evaluate(const Kinematics& kinematics, TreeMatrix& matrix) {
  compose(kinematics);
  spread_columns(kinematics);
  for (const TreeLayout::Step& step : layout_.steps()) {
    const CompositeInertia& inertia = composites_[step.child];
    const Plain3 origin(kinematics.poses[step.child].position);
    for (std::uint32_t p = step.first; p < step.first + step.rates; ++p) {
      const Column& column = kinematics.columns[layout_.rate(p)];
      const Plain3 angular(column.angular);
      const Plain3 linear = Plain3(column.linear) + angular.cross(origin - Plain3(column.point));
      fill_row(p, origin, inertia(angular, linear), matrix.row(p));
      // |2 linear . (angular x h)| is no greater than the sum of the two, as h^2 < mass times trace.
      matrix.size(p) = 2.0 * (inertia.tensor.trace() * angular.squared_norm() + inertia.mass * linear.squared_norm());
    }
  }
}

}  // namespace koppel
