// All distinct answers to one question, found from many starts; follows pinik.solving.branches.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "run.hpp"
#include "settings.hpp"
#include "starts.hpp"
#include "watch.hpp"

#include <ctime>

namespace pinik {

struct Branch {
  Vector q;
  bool inside = false;
  int hits = 0, found_at = 0;
  double radius = 0.0;
};

inline double cpu_now() { timespec t; clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t); return t.tv_sec + 1e-9 * t.tv_nsec; }
inline double knob(const char* name, double value) {
  const char* given = std::getenv(name);
  return given ? std::atof(given) : value;
}

template <int Rows>
class Branches {
 public:
  Branches(const Problem& problem, const Settings& settings, const Interrupts& interrupts)
      : problem_(problem), settings_(settings), watch_(interrupts, settings.time_limit), kinematics_(problem),
        run_(settings_.solver, kinematics_), limits_(Limits::of(*problem.mechanism, settings.limits, problem.constants.barely_outside)),
        loose_(limits_.loosened()), starts_(problem, limits_, settings.seed) {
    kinematics_.target_jacobian = settings.solver.target_jacobian;
  }

  std::vector<Branch> found;
  std::vector<std::pair<int, int>> log;
  std::int64_t tried = 0, iterations = 0, failed = 0, left = 0;

  void operator()(Vector& start, std::uint64_t target, std::int64_t most) {
    static const double share = knob("SHARE", 0.5), reach = knob("REACH", 0.5);
    static const int patience = (int)knob("PATIENCE", settings_.patience.iterations);
    watch_.start();
    found.clear();
    log.clear();
    tried = iterations = failed = left = 0;
    given_ = start;
    limits_.wrap(given_, start);
    Vector q, before;
    static const int M = (int)knob("M", 128);
    static const double near_weight = knob("NEARW", 0.0);
    Vector& scores = starts_.ranked(kinematics_, given_);
    std::vector<int> order(scores.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = (int)i;
    const int count = std::min<int>(M, (int)order.size());
    std::nth_element(order.begin(), order.begin() + count - 1, order.end(), [&](int a, int b) { return scores[a] < scores[b]; });
    order.resize(count);
    const int n = (int)problem_.coordinates.size();
    Eigen::MatrixXf angles(count, n);
    for (int i = 0; i < count; ++i) for (int c = 0; c < n; ++c) angles(i, c) = starts_.table()(problem_.coordinates[c].entry, order[i]) / (2 * M_PI);
    Eigen::VectorXf least = Eigen::VectorXf::Constant(count, 1e9f), sum(count);
    const auto mark = [&](const Vector& from, float factor) {
      sum.setZero();
      for (int c = 0; c < n; ++c) {
        const float own = (float)(from[problem_.coordinates[c].entry] / (2 * M_PI));
        const float* a = angles.col(c).data();
        for (int i = 0; i < count; ++i) { float d = a[i] - own; d -= std::nearbyintf(d); sum[i] += d * d; }
      }
      for (int i = 0; i < count; ++i) least[i] = std::min(least[i], factor * sum[i]);
    };
    static const float fs = (float)knob("FS", 1.0);
    static const int mode = (int)knob("MODE", 0), ratio = (int)knob("RATIO", 1);
    static const std::int64_t most_iterations = (std::int64_t)knob("MAXIT", 1000);
    std::vector<Vector> queue;
    std::size_t taken = 0;
    std::int64_t from_table = 0;
    for (std::int64_t number = 0; number <= most; ++number) {
      if (number == 0) q = given_;
      else if (mode && taken < queue.size() && number % (ratio + 1) != 0) q = queue[taken++];
      else if (from_table++ < count) {
        int best; least.maxCoeff(&best);
        q = given_;
        for (const Coordinate& c : problem_.coordinates) q[c.entry] = starts_.table()(c.entry, order[best]);
      } else starts_.next(kinematics_, given_, target, number + 1000, q);
      mark(q, 1.0f);
      ++tried;
      RunSettings run{std::min(settings_.max_iterations, most_iterations), {patience, settings_.patience.progress}, true, false, false, true, false};
      Status ended = Status::running;
      const std::int64_t had = iterations;
      int known = -1;
      const auto see = [&](const Linearization<Rows>& at, std::int64_t iteration, std::int64_t, Status status) {
        ended = status;
        ++iterations;
        if (status == Status::converged) { q = at.q; return false; }
        if (status != Status::running) return false;
        if (iteration > 0 && !found.empty()) {
          for (std::size_t k = 0; k < found.size(); ++k) {
            const double now = distance(at.q, found[k].q);
            if (now < found[k].radius && now < share * distance(before, found[k].q)) { known = (int)k; return false; }
          }
        }
        before = at.q;
        return true;
      };
      run_(q, given_, loose_, loose_, run, see);
      if (known >= 0) { ++found[known].hits; ++left; log.push_back({known, (int)(iterations - had)}); continue; }
      if (ended != Status::converged) { ++failed; log.push_back({-1, (int)(iterations - had)}); continue; }
      for (std::size_t k = 0; k < found.size() && known < 0; ++k)
        if (distance(q, found[k].q) < problem_.constants.same_answer) known = (int)k;
      log.push_back({known >= 0 ? known : (int)found.size(), (int)(iterations - had)});
      if (known >= 0) { ++found[known].hits; continue; }
      Branch b;
      b.q = q;
      limits_.wrap(b.q, given_);
      b.inside = distance(b.q, q) < 1e-9;
      b.hits = 1;
      b.found_at = (int)number;
      Linearization<Rows> at;
      b.q = b.inside ? b.q : q;
      at.q = b.q;
      kinematics_.linearize(at);
      const Eigen::JacobiSVD<Eigen::MatrixXd> svd(Eigen::MatrixXd(at.J));
      const auto& s = svd.singularValues();
      b.radius = reach * s[s.size() - 1] / problem_.size_of_chain;
      found.push_back(b);
      if (mode) for (const Coordinate& c : problem_.coordinates) {
        Vector other = b.q;
        if (mode & 1) { other[c.entry] += M_PI; queue.push_back(other); }
        if (mode & 2) { other = b.q; other[c.entry] += 2.0; queue.push_back(other); other = b.q; other[c.entry] -= 2.0; queue.push_back(other); }
      }
      if (mode & 4) for (std::size_t k = 0; k + 1 < found.size(); ++k) {
        // swap pieces: differences between two found ones applied to the third
        for (std::size_t l = 0; l + 1 < found.size(); ++l) if (l != k) {
        Vector other = b.q; other += found[k].q - found[l].q; queue.push_back(other); }
      }
      mark(b.q, fs);
    }
  }

  double distance(const Vector& a, const Vector& b) const {
    double sum = 0.0;
    for (const Coordinate& c : problem_.coordinates) {
      double d = a[c.entry] - b[c.entry];
      d -= 2.0 * M_PI * std::nearbyint(d / (2.0 * M_PI));
      sum += d * d;
    }
    return std::sqrt(sum);
  }

 private:
  const Problem& problem_;
  const Settings settings_;
  Watch watch_;
  Kinematics<Rows> kinematics_;
  Run<Rows> run_;
  const Limits limits_, loose_;
  Starts<Rows> starts_;
  Vector given_;
};

}  // namespace pinik
