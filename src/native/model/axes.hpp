// The axes and the origin of a frame during a walk along a chain, each in one vector register.
#pragma once

#include "spatial.hpp"

namespace pinik {

using Column = double __attribute__((vector_size(32)));  // three numbers; the fourth is unused

struct Axes {
  Column x{1.0, 0.0, 0.0}, y{0.0, 1.0, 0.0}, z{0.0, 0.0, 1.0}, p{};

  // Go on to a frame that is placed in this one, then `shift` along its z axis, and turned about that axis.
  void go_to(const Placement& placement, double shift, double cosine, double sine) {
    const Mat3& R = placement.R;
    // Applying the turn to the placement first shortens the dependency chain from joint to joint.
    const Vec3 a = cosine * R.col(0) + sine * R.col(1), b = cosine * R.col(1) - sine * R.col(0), c = R.col(2);
    go_to(a, b, c, placement.p + shift * c);
  }

  // Go on to a frame that is placed in this one.
  void go_to(const Placement& placement) {
    go_to(placement.R.col(0), placement.R.col(1), placement.R.col(2), placement.p);
  }

  Placement placement() const {
    Placement at;
    for (int k = 0; k < 3; ++k) at.R.row(k) << x[k], y[k], z[k];
    at.p << p[0], p[1], p[2];
    return at;
  }

 private:
  void go_to(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& t) {
    p += x * t[0] + y * t[1] + z * t[2];
    const Column next_x = x * a[0] + y * a[1] + z * a[2];
    const Column next_y = x * b[0] + y * b[1] + z * b[2];
    z = x * c[0] + y * c[1] + z * c[2];
    x = next_x;
    y = next_y;
  }
};

}  // namespace pinik
