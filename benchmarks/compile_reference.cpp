// SPDX-License-Identifier: BSL-1.0
// compile_files.py compiles it beside the files of the diagnosis, to learn how fast a compiler is at this
// minute: nothing of ours, only libraries that they use.
#include <Eigen/Dense>
#include <nlohmann/json.hpp>

#include <iostream>

int main() {
    const auto in = nlohmann::json::parse(std::cin);
    Eigen::MatrixXd a(3, 3);
    Eigen::VectorXd b(3);
    for (int i = 0; i < 9; ++i) a(i / 3, i % 3) = in.at("a").at(static_cast<std::size_t>(i)).get<double>();
    for (int i = 0; i < 3; ++i) b[i] = in.at("b").at(static_cast<std::size_t>(i)).get<double>();
    const Eigen::VectorXd x = a.llt().solve(b);
    std::cout << nlohmann::json{{"x", x[0]}, {"n", x.norm()}}.dump(2) << '\n';
}
