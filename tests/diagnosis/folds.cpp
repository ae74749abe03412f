// SPDX-License-Identifier: BSL-1.0
#include "workshop.hpp"

#include <quadrant/diagnosis/which/candidate.hpp>

#include <doctest/doctest.h>

using namespace quadrant::diagnosis;

TEST_CASE("folds: where a number of a valley meets its bound, the others stop with it") {
    // Mass and force constant times one factor move the axis alike: only the owner's tolerances settle that
    // factor. Without the fold it goes beyond the bound of the mass.
    constexpr double stiff = 1e9, known = 2.5e4;
    Eigen::MatrixXd along(2, 2);
    along << 1, -1, -1, 1;
    detail::fold_sums sums;
    sums.all = {2 * stiff * along + known * Eigen::MatrixXd::Identity(2, 2), Eigen::VectorXd::Zero(2)};
    sums.of.fill({Eigen::MatrixXd::Zero(2, 2), Eigen::VectorXd::Zero(2)});
    sums.of[0] = {stiff * along, Eigen::Vector2d(-400, -400)};
    sums.low = Eigen::Vector2d(-0.003, -0.05);
    sums.high = Eigen::Vector2d(0.003, 0.05);
    for (const bool replayed : {false, true}) {
        const Eigen::VectorXd step = detail::step_without(sums, 0, replayed);
        CAPTURE(replayed);
        CHECK(workshop::near(std::abs(step[0]), 0.003, 1e-12));
        // What the two differ by costs the square of it: the stiff direction against the weak one.
        CHECK(std::abs(step[1] - step[0]) < 1e-5);
    }
}
TEST_CASE("folds: behind a drive's replay what a fold alone shows stays where it is without it") {
    // The first number shows in the first fold alone, and hardly pulls at the others; the second one in all.
    detail::fold_sums sums;
    sums.all = {Eigen::Vector2d(1e4 + 1, 5e3).asDiagonal(), Eigen::VectorXd::Zero(2)};
    sums.of.fill({Eigen::MatrixXd::Zero(2, 2), Eigen::VectorXd::Zero(2)});
    sums.of[0] = {Eigen::Vector2d(1e4, 1e3).asDiagonal(), Eigen::Vector2d(-0.8, -40)};
    sums.low = Eigen::Vector2d(-10, -10);
    sums.high = Eigen::Vector2d(10, 10);
    const Eigen::VectorXd logged = detail::step_without(sums, 0, false),
                          behind_drive = detail::step_without(sums, 0, true);
    CHECK(std::abs(logged[0]) == doctest::Approx(0.8).epsilon(0.01));
    CHECK(std::abs(behind_drive[0]) < 1e-3);
    CHECK(behind_drive[1] == doctest::Approx(logged[1]).epsilon(0.03));
}
