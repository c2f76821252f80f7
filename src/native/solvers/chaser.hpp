// One target during a sweep of cyclic coordinate descent; follows pinik.solvers.chaser.
#pragma once

#include "../problem/kinematics.hpp"

namespace pinik {

// The frame (effector) and its goal, moved along with each joint update without computing forward kinematics again.
struct Chaser {
  const Term* term = nullptr;
  double weight = 1.0, alpha = 0.0, max_residual = infinity, no_direction = 0.0;
  double share = 1.0;     // the part of a tolerance inside which nothing draws
  bool loose = false;     // whether what is inside its tolerance draws nothing
  int axes = 0;           // how many columns of U and V are used: 0, 1 or 3
  bool has_goal = false, has_at = false;
  Vec3 p, goal, at;
  Mat3 U, V;              // the effector's axes and their goals
  Mat3 reference, box;    // the axes in which axes are free, and those of the tolerance's box

  template <int Rows>
  Chaser(const Kinematics<Rows>& kinematics, std::size_t index, double alpha, double max_residual)
      : term(&kinematics.problem.terms[index]), weight(term->weight * term->weight), alpha(alpha),
        max_residual(max_residual), no_direction(kinematics.problem.constants.no_direction),
        share(kinematics.problem.constants.slack_share), loose(kinematics.loose) {
    const Constants& constants = kinematics.problem.constants;
    if (term->tolerance.orientation > constants.wide_angle) this->alpha *= constants.ccd_wide_position;
    const Placement frame = kinematics.frame(*term);
    const Goal wanted = kinematics.wanted(index);
    p = frame.p;
    goal = wanted.position;
    at = wanted.at;
    has_goal = term->asks_position;
    reference = kinematics.reference_axes(*term);
    box = kinematics.box_axes(*term, wanted);
    if (term->asks_rotation) {
      axes = 3;
      U = frame.R;
      V = wanted.rotation;
    } else if (term->asks_axis) {
      axes = 1;
      has_at = term->asks_at;
      U.col(0) = frame.R * term->axis;
      V.col(0) = wanted.direction;
    }
  }

  bool moved_by(int joint) const {
    return term->in_frame_support[static_cast<std::size_t>(joint)] !=
           term->in_reference_support[static_cast<std::size_t>(joint)];
  }

  bool moves_frame(int joint) const { return term->in_frame_support[static_cast<std::size_t>(joint)]; }

  bool within() const {
    const Tolerance& tolerance = term->tolerance;
    if (has_goal) {
      const Vec3 e = left();
      if (tolerance.is_box ? ((box.transpose() * e).array().abs() > tolerance.box.array()).any()
                           : e.squaredNorm() > tolerance.position * tolerance.position)
        return false;
    }
    return axes == 0 || angle() <= tolerance.orientation;
  }

  // The orientation error [rad].
  double angle() const {
    double angle = 0.0;
    if (axes == 3) {
      log3(V * U.transpose(), angle);
      return angle;
    }
    const Vec3 u = U.col(0), v = facing();
    return std::atan2(u.cross(v).norm(), u.dot(v));
  }

  // Σ w c dᵀ over the vectors c that the joint moves and their goals d, both relative to `origin`.
  Mat3 correlation(int joint, const Vec3& origin) const {
    Mat3 M = Mat3::Zero(), drawing;
    if (drawn_axes(drawing)) {
      if (axes == 3)
        M.noalias() = U * drawing.transpose();
      else
        M.noalias() = U.col(0) * drawing.col(0).transpose();
    }
    for_each_pair(origin, [&](const Vec3& c, const Vec3& d, double w) {
      M.noalias() += (w * (c - origin)) * (d - origin).transpose();
    });
    if (weight != 1.0) M *= weight;
    if (!moves_frame(joint)) M.transposeInPlace();
    return M;
  }

  // Call `see` with each point of the effector, its goal and their weight.
  template <class See>
  void for_each_pair(const Vec3& origin, See see) const {
    Vec3 drawn;
    if (has_goal && drawn_goal(drawn)) {
      double w = alpha;
      if (axes > 0) {
        const double c = (p - origin).squaredNorm(), d = (drawn - origin).squaredNorm(), longer = std::max(c, d);
        w *= 1.0 + (longer > 0.0 ? std::sqrt(std::min(c, d) / longer) : 1.0);
      }
      see(p, drawn, w);
    }
    if (has_at && !loose) {
      const double squared = (at - p).squaredNorm();
      if (squared > no_direction * no_direction) see(Vec3(p + std::sqrt(squared) * U.col(0)), at, 1.0 / squared);
    }
  }

  // The part of `correlation` perpendicular to a joint's axis: Σ w c·d, Σ w a·(c × d), and the error of these sums for a
  // relative error of 1 in every coordinate.
  struct Across {
    double cosine = 0.0, sine = 0.0, blur = 0.0;
  };

  Across across(int joint, const Vec3& axis, const Vec3& origin) const {
    Across sum;
    const auto part = [&](const Vec3& vector) -> Vec3 { return vector - axis * axis.dot(vector); };
    const auto add = [&](const Vec3& c, const Vec3& d, double w, double size) {
      sum.cosine += w * c.dot(d);
      sum.sine += w * axis.dot(c.cross(d));
      sum.blur += w * size * (c.norm() + d.norm());
    };
    for_each_pair(origin, [&](const Vec3& c, const Vec3& d, double w) {
      add(part(c - origin), part(d - origin), w, c.norm() + d.norm() + origin.norm());
    });
    Mat3 drawing;
    if (drawn_axes(drawing))
      for (int column = 0; column < axes; ++column) add(part(U.col(column)), part(drawing.col(column)), 1.0, 1.0);
    return {weight * sum.cosine, moves_frame(joint) ? weight * sum.sine : -weight * sum.sine, weight * sum.blur};
  }

  // Rotate about `origin`, or shift, whatever the joint moves: the effector, the goal, or both.
  void carry(int joint, const Vec3& origin, const Mat3* R, const Vec3& shift) {
    auto moved = [&](const Vec3& point) -> Vec3 { return R ? Vec3(origin + *R * (point - origin)) : Vec3(point + shift); };
    if (term->in_frame_support[static_cast<std::size_t>(joint)]) {
      p = moved(p);
      if (R && axes > 0) U = *R * U;
    }
    if (term->in_reference_support[static_cast<std::size_t>(joint)]) {
      if (has_goal) goal = moved(goal);
      if (has_at) at = moved(at);
      if (R && axes > 0) V = *R * V;
      if (R) {
        reference = *R * reference;
        box = *R * box;
      }
    }
  }

 private:
  // The vector from the effector to the nearest position that is allowed.
  Vec3 left() const {
    const Vec3 e = goal - p;
    if (!term->has_free_axes) return e;
    return reference * term->along.cwiseProduct(Vec3(reference.transpose() * e));
  }

  // The position that draws the effector: the goal, or the nearest one at the edge of a tolerance; if it is farther away
  // than D_max, the point on the way to it at the distance D_max. False if nothing draws.
  bool drawn_goal(Vec3& drawn) const {
    drawn = goal;
    if (max_residual == infinity && !term->has_free_axes && !loose) return true;
    Vec3 e = left();
    if (loose) {
      const Tolerance& tolerance = term->tolerance;
      e = tolerance.is_box ? outside_box(e, share * tolerance.box, box).left
                           : outside_ball(e, share * tolerance.position).left;
      if (e.isZero(0.0)) return false;
    }
    const double length = e.norm();
    drawn = length <= max_residual ? Vec3(p + e) : Vec3(p + e * (max_residual / length));
    return true;
  }

  // The axes that draw those of the effector: V, or the nearest ones at the edge of a tolerance. False if nothing draws.
  bool drawn_axes(Mat3& drawing) const {
    if (axes == 0) return false;
    if (!loose) {
      drawing = V;
      return !has_at;
    }
    double angle = 0.0;
    Vec3 turn;
    if (axes == 3)
      turn = log3(V * U.transpose(), angle);
    else
      turn = shortest_rotation(U.col(0), facing(), angle);
    const double left = angle - share * term->tolerance.orientation;
    if (left <= 0.0) return false;
    const Mat3 R = rotation_about(turn / angle, left);
    if (axes == 3)
      drawing = R * U;
    else
      drawing.col(0) = R * U.col(0);
    return true;
  }

  // The direction to the point to look at; the axis itself if the point is too near to have a direction.
  Vec3 facing() const {
    if (!has_at) return V.col(0);
    const Vec3 line = at - p;
    const double distance = line.norm();
    return distance < no_direction ? Vec3(U.col(0)) : Vec3(line / distance);
  }
};

}  // namespace pinik
