#include "carve/refine/bending.h"

#include <ceres/ceres.h>

#include <cmath>

namespace carve::refining {
namespace {

constexpr double kOutlineWeight = 10;
constexpr int kSteps = 1;               // the problem is linear
constexpr std::size_t kDirect = 25000;  // vertices up to which factorising is faster
constexpr int kConjugateSteps = 60;     // rounds follow that start from here

double mean_squared_edge(const BendingProblem& p, int v) {
  double sum = 0;
  for (std::uint32_t i = p.first[v]; i < p.first[v + 1]; ++i)
    sum += (p.positions[p.neighbours[i]] - p.positions[v]).squaredNorm();
  return sum / (p.first[v + 1] - p.first[v]);
}

/// weight * (sum of coefficient * offset + constant).
class Linear : public ceres::CostFunction {
 public:
  Linear(std::vector<double> coefficients, double constant)
      : coefficients_(std::move(coefficients)), constant_(constant) {
    mutable_parameter_block_sizes()->assign(coefficients_.size(), 1);
    set_num_residuals(1);
  }
  bool Evaluate(const double* const* offsets, double* residuals, double** jacobians) const override {
    residuals[0] = constant_;
    for (std::size_t i = 0; i < coefficients_.size(); ++i) {
      residuals[0] += coefficients_[i] * *offsets[i];
      if (jacobians && jacobians[i]) *jacobians[i] = coefficients_[i];
    }
    return true;
  }

 private:
  std::vector<double> coefficients_;
  double constant_;
};

void add_bending(const BendingProblem& p, int v, std::vector<double>& offsets, ceres::Problem& ceres) {
  const double count = p.first[v + 1] - p.first[v], scale = p.stiffness[v] / mean_squared_edge(p, v);
  std::vector<double> coefficients;
  std::vector<double*> blocks;
  const auto add = [&](int vertex, double coefficient) {
    if (p.held[vertex]) return;
    coefficients.push_back(scale * coefficient);
    blocks.push_back(&offsets[vertex]);
  };
  add(v, -1);
  for (std::uint32_t i = p.first[v]; i < p.first[v + 1]; ++i)
    add(p.neighbours[i], p.normals[p.neighbours[i]].dot(p.normals[v]) / count);
  const double constant = p.stiffness[v] * (umbrella_curvature(p, v) - p.curvature[v]);
  ceres.AddResidualBlock(new Linear(std::move(coefficients), constant), nullptr, blocks);
}

}  // namespace

double umbrella_curvature(const BendingProblem& p, int v) {
  Vec3 sum = Vec3::Zero();
  for (std::uint32_t i = p.first[v]; i < p.first[v + 1]; ++i) sum += p.positions[p.neighbours[i]] - p.positions[v];
  return p.normals[v].dot(sum) / (p.first[v + 1] - p.first[v]) / mean_squared_edge(p, v);
}

std::vector<double> solve(const BendingProblem& p) {
  std::vector<double> offsets(p.positions.size());
  ceres::Problem problem;
  for (std::size_t v = 0; v < offsets.size(); ++v)
    if (!p.held[v]) {
      problem.AddParameterBlock(&offsets[v], 1);
      problem.AddResidualBlock(new Linear({1}, 0), nullptr, &offsets[v]);
    }
  for (std::size_t v = 0; v < offsets.size(); ++v)
    if (!p.held[v] && !std::isnan(p.curvature[v])) add_bending(p, static_cast<int>(v), offsets, problem);
  for (const OutlinePull& pull : p.pulls) {
    const double weight = kOutlineWeight * std::sqrt(pull.weight);
    if (!p.held[pull.vertex])
      problem.AddResidualBlock(new Linear({weight * pull.gain}, weight * pull.distance), nullptr,
                               &offsets[pull.vertex]);
  }
  ceres::Solver::Options options;
  options.num_threads = 1;  // sums in one order
  options.linear_solver_type = offsets.size() <= kDirect ? ceres::SPARSE_NORMAL_CHOLESKY : ceres::CGNR;
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.preconditioner_type = ceres::JACOBI;
  options.max_linear_solver_iterations = kConjugateSteps;
  options.eta = 1e-3;
  options.max_num_iterations = kSteps;
  options.initial_trust_region_radius = 1e8;
  options.function_tolerance = 1e-3;
  options.max_solver_time_in_seconds = 1e9;  // time must not decide
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return offsets;
}

}  // namespace carve::refining
