// Linear isotropic elasticity.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace trackbed::fem {

using Mat6 = Eigen::Matrix<double, 6, 6>;

/// An isotropic elastic solid.
struct Elastic {
  double young;    // E [Pa]
  double poisson;  // nu [-], above -1 and below 0.5
  double density;  // rho [kg/m3]

  double shear_modulus() const { return young / (2 * (1 + poisson)); }
  double lame() const { return young * poisson / ((1 + poisson) * (1 - 2 * poisson)); }
  /// Modulus where no strain across is possible (oedometer) [Pa].
  double constrained_modulus() const { return lame() + 2 * shear_modulus(); }
  double pressure_wave_speed() const { return std::sqrt(constrained_modulus() / density); }  // c_p [m/s]
  double shear_wave_speed() const { return std::sqrt(shear_modulus() / density); }           // c_s [m/s]

  /// Stress from strain [Pa]; order xx, yy, zz, xy, yz, zx, with engineering shear strains.
  Mat6 stiffness() const {
    Mat6 d = Mat6::Zero();
    d.topLeftCorner<3, 3>().setConstant(lame());
    d.diagonal().head<3>().array() += 2 * shear_modulus();
    d.diagonal().tail<3>().setConstant(shear_modulus());
    return d;
  }
};

}  // namespace trackbed::fem
