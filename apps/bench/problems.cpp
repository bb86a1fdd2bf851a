#include "bench/problems.hpp"

namespace koppel::app::bench {

const std::vector<Problem>& problems() {
  static const std::string iftomm_in_quadruple =
      "IFToMM library of multibody benchmarks; reduced equations in quadruple precision, two tolerances agree";
  static const std::string quadruple = "reduced equations in quadruple precision, two tolerances agree";
  static const std::string extended = "apps/bench/digits.py: reduced equations in extended precision, two step sizes";
  static const std::vector<Problem> table = {
      {"pendulum", 10.0, {{"pivot.angle", -0.278680673569982948}}, iftomm_in_quadruple},
      {"double_pendulum",
       10.0,
       {{"first.angle", -0.56847466401595018878}, {"second.angle", 0.04208093608354549}},
       quadruple},
      {"triple_pendulum",
       5.0,
       {{"first.angle", -1.7295409718888748598}, {"tip.x", -1.5051776184247230166}, {"tip.y", -1.1399730512884350539}},
       quadruple},
      {"nfourbar", 10.0, {{"bar0.angle", -31.750597186986101817}}, iftomm_in_quadruple},
      {"andrews",
       0.03,
       {{"beta.angle", 15.8107711951537070971},
        {"theta.angle", -15.7563710584118394697},
        {"gamma.angle", 0.0408222401196458048583},
        {"phi.angle", -0.534730116342079593770},
        {"delta.angle", 0.524409965879954069372},
        {"omega.angle", 0.534730116342079593770},
        {"epsilon.angle", 1.04808074104193787307}},
       "IVP test set; its equations in quadruple precision, two step sequences agree"},
      {"bricard",
       10.0,
       {{"p0.angle", 0.000269048883324646512}, {"p1.angle", -0.000268976515492639812}},
       iftomm_in_quadruple},
      {"governor",
       0.1,
       {{"slider.displacement", 0.523836475569575694}, {"shaft.angle", 0.622106681402687571}},
       iftomm_in_quadruple},
      {"car_axis",
       3.0,
       {{"left.x", 0.049345578427524092132},
        {"left.y", 0.49698946023000810676},
        {"right.x", 1.0417425248854261152},
        {"right.y", 0.37391102726536581936}},
       "IVP test set; its equations in quadruple precision, two tolerances agree"},
      {"folding_slidercrank", 10.0, {{"crank.angle", 35.568654089393008946}}, extended, 9e-14},
      {"heavy_top",
       2.0,
       {{"point.rotation.w", 0.122947135041534186},
        {"point.rotation.x", -0.491079892550027539},
        {"point.rotation.y", 0.350430030343621307},
        {"point.rotation.z", -0.787986887550485059}},
       extended,
       6e-16},
      {"top",
       1.0,
       {{"point.rotation.w", 0.903301059526963272},
        {"point.rotation.x", -0.250239031902422485},
        {"point.rotation.y", 0.066088766218768667},
        {"point.rotation.z", -0.342140172662733189}},
       "closed form (apps/bench/digits.py)"},
      {"satellite",
       40.0,
       {{"satellite.rotation.w", 0.994460544968359994},
        {"satellite.rotation.x", 0.001622716291223255},
        {"satellite.rotation.y", 0.105096588144691146},
        {"satellite.rotation.z", -0.000546308901434388}},
       extended,
       4e-15},
      {"fourbar_free", 10.0, {{"crank.angle", -2.404042112231594440}}, extended, 1e-14},
      {"rsur_free", 10.0},
      {"fivelink_free", 1.0},
      {"stewart_free", 1.0},
      {"gyroscope", 1.0},
  };
  return table;
}

}  // namespace koppel::app::bench
