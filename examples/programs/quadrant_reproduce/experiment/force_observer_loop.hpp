// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../milling_table.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <vector>

namespace quadrant_reproduce {

/// Eqs. (D.3), (D.11), (D.15) in continuous time, with L from poles by Ackermann's formula.
class force_observer_loop {
public:
    using complex = std::complex<double>;
    force_observer_loop(const thesis::axis& a, const std::vector<double>& hertz, double decay)
        : axis_(a), F_(Eigen::MatrixXd::Zero(size(hertz), size(hertz))), G_(Eigen::VectorXd::Zero(size(hertz))),
          H_(Eigen::RowVectorXd::Zero(size(hertz))) {
        F_(0, 1) = 1, F_(1, 1) = -a.A.value(), G_(1) = a.B.value();
        for (std::size_t i = 0; i < hertz.size(); ++i) {
            const auto q = Eigen::Index(2 + 2 * i);
            const double w = 2 * thesis::pi_ * hertz[i];
            F_(1, q) = a.B.value(), F_(q, q + 1) = 1, F_(q + 1, q) = -w * w, H_(q) = 1;
        }
        // Harmonics as they are and both other poles at zero, all shifted left by the decay.
        Eigen::MatrixXd shifted = Eigen::MatrixXd::Identity(F_.rows(), F_.rows());
        const auto one = shifted;
        for (int i = 0; i < 2; ++i) shifted = shifted * (F_ + decay * one);
        for (const double f : hertz) {
            const double w = 2 * thesis::pi_ * f;
            shifted = shifted * (F_ * F_ + 2 * decay * F_ + (decay * decay + w * w) * one);
        }
        Eigen::MatrixXd sees(F_.rows(), F_.rows());
        Eigen::RowVectorXd line = Eigen::RowVectorXd::Unit(F_.rows(), 0);
        for (Eigen::Index i = 0; i < F_.rows(); ++i, line = line * F_) sees.row(i) = line;
        L_ = shifted * sees.inverse() * Eigen::VectorXd::Unit(F_.rows(), F_.rows() - 1);
    }
    /// Eq. (D.15).
    complex sensitivity(quadrant::frequency f) const {
        const auto loop = thesis::loop_around(thesis::model_of(axis_), axis_);
        const complex s = quadrant::analysis::laplace(f), plant = complex(thesis::model_of(axis_)(f));
        const complex pi = axis_.kp.value() + axis_.ki.value() / s;
        const complex p_pi = thesis::position_gain.value() * pi;
        const complex velocity = (1.0 / loop.velocity_sensitivity(f) - 1.0) / plant; // PI Vest N
        Eigen::MatrixXcd m = s * Eigen::MatrixXcd::Identity(F_.rows(), F_.rows());
        m -= (F_ - G_ * H_ - L_ * Eigen::RowVectorXd::Unit(F_.rows(), 0)).cast<complex>();
        const Eigen::VectorXcd in = L_.cast<complex>() - G_.cast<complex>() * (p_pi + velocity);
        // Singular at the harmonics, where the loop gain is infinite: no rank is judged here.
        const complex fed = (H_.cast<complex>() * m.partialPivLu().solve(in))(0);
        return 1.0 / (1.0 + plant * p_pi + plant * velocity + plant * fed);
    }
    /// Error under 1 V, eq. (D.14) [um].
    double error(quadrant::frequency f) const {
        return 1e6 * std::abs(complex(thesis::model_of(axis_)(f)) * sensitivity(f));
    }

private:
    static Eigen::Index size(const std::vector<double>& hertz) { return Eigen::Index(2 + 2 * hertz.size()); }
    const thesis::axis& axis_;
    Eigen::MatrixXd F_;
    Eigen::VectorXd G_, L_;
    Eigen::RowVectorXd H_;
};

} // namespace quadrant_reproduce
