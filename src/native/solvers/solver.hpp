// The parameters of the four methods; follows the dataclasses of pinik.solvers.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "../model/spatial.hpp"

namespace pinik {

enum class Method { ccd, transpose, pseudo_inverse, damped_least_squares };
enum class DampingRule { constant, residual, sugihara, manipulability };

// The parameters of all methods. Python hands over those of the method that is used; the others are not read.
struct Solver {
  Method method = Method::damped_least_squares;
  DampingRule rule = DampingRule::constant;
  double max_step = infinity, max_residual = infinity;
  double step_size = 1.0;
  bool target_jacobian = false;
  double alpha = 0.0;  // of the transpose; 0 means the optimal step size
  double cutoff = 0.0, rest_gain = 0.0;
  std::vector<std::pair<int, double>> rest_posture;  // joint, angle
  double damping = 0.0, manipulability = 0.0;
  bool by_svd = false;
  std::vector<double> stiffness;  // by coordinate; empty if all are 1
  double relaxation = 1.0, loose_relaxation = 1.0, position_weight = 1.0;
  bool printed_scaling = false;

  bool sweeps() const { return method == Method::ccd; }
};

}  // namespace pinik
