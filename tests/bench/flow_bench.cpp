// Iterations, time and memory of the flow solver beside the thesis' own, conjugate residuals with
// an incomplete factorization without fill (section 5.1.1.1), on the same meshes and matrices.

#include <chrono>
#include <cstdio>
#include <string>

#include "core/base/parallel.h"
#include "core/flow/stokes.h"
#include "core/flow/stokes_system.h"
#include "core/io/medit.h"
#include "tests/support/flow_meshes.h"

namespace lamella {
namespace {

constexpr int kMostIterations = 20000;
constexpr double kMostSeconds = 120;

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Conjugate residuals on (5.3) with the unknowns of a node side by side, M its LU factorization by
/// blocks of a node within the pattern of the mesh.
class Reference {
 public:
  using Block = Mat<4>;
  using Row = Vec<4>;

  explicit Reference(const flow::StokesSystem<3>& s) : s_(s), k_(s.column.size()) {
    for (std::size_t i = 0; i < s.rows(); ++i)
      for (std::int32_t e = s.start[i]; e < s.start[i + 1]; ++e) {
        const auto j = static_cast<std::size_t>(s.column[e]);
        Block& b = k_[e];
        b.setZero();
        if (!s.wall[i] && !s.wall[j])
          b.topLeftCorner<3, 3>() = s.of_velocity[e].a * Mat<3>::Identity();
        else if (i == j)
          b.topLeftCorner<3, 3>().setIdentity();
        if (!s.wall[i]) b.topRightCorner<3, 1>() = s.of_pressure[e].bt;
        if (!s.wall[j]) b.bottomLeftCorner<1, 3>() = s.of_velocity[e].b.transpose();
        b(3, 3) = -s.of_pressure[e].c;
      }
    factorize();
  }

  /// Iterations until the residual has fallen by `tolerance`, negative when it has not.
  int solve(double tolerance) {
    const std::size_t n = s_.rows();
    std::vector<Row> r(n, Row::Zero()), z(n), p, q, w(n), az(n);
    for (std::size_t k = 0; k < s_.openings[0].rows.size(); ++k) {
      const std::int32_t i = s_.openings[0].rows[k];
      if (!s_.wall[i]) r[i].head<3>() = -s_.openings[0].load[k];
    }
    const double first = norm(r), begin = now();
    precondition(r, z);
    multiply(z, az);
    p = z;
    q = az;
    double rho = dot(z, az);
    for (int it = 1; it <= kMostIterations; ++it) {
      precondition(q, w);
      const double step = rho / dot(q, w);
      for (std::size_t i = 0; i < n; ++i) {
        r[i] -= step * q[i];
        z[i] -= step * w[i];
      }
      const double share = norm(r) / first;
      if (share < tolerance) return it;
      if (!std::isfinite(share) || now() - begin > kMostSeconds) return -it;
      multiply(z, az);
      const double next = dot(z, az), beta = next / rho;
      rho = next;
      for (std::size_t i = 0; i < n; ++i) {
        p[i] = z[i] + beta * p[i];
        q[i] = az[i] + beta * q[i];
      }
    }
    return -kMostIterations;
  }

 private:
  void factorize() {
    lu_ = k_;
    const std::size_t n = s_.rows();
    diagonal_.resize(n);
    inverse_.resize(n);
    std::vector<std::int32_t> place(n, -1);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::int32_t e = s_.start[i]; e < s_.start[i + 1]; ++e) place[s_.column[e]] = e;
      for (std::int32_t e = s_.start[i]; e < s_.start[i + 1]; ++e) {
        const auto k = static_cast<std::size_t>(s_.column[e]);
        if (k >= i) break;
        lu_[e] = (lu_[e] * inverse_[k]).eval();
        for (std::int32_t f = diagonal_[k] + 1; f < s_.start[k + 1]; ++f)
          if (const std::int32_t at = place[s_.column[f]]; at >= 0) lu_[at] -= lu_[e] * lu_[f];
      }
      diagonal_[i] = place[i];
      inverse_[i] = lu_[diagonal_[i]].inverse();
      for (std::int32_t e = s_.start[i]; e < s_.start[i + 1]; ++e) place[s_.column[e]] = -1;
    }
  }
  void precondition(const std::vector<Row>& r, std::vector<Row>& z) const {
    for (std::size_t i = 0; i < r.size(); ++i) {
      z[i] = r[i];
      for (std::int32_t e = s_.start[i]; e < diagonal_[i]; ++e) z[i] -= lu_[e] * z[s_.column[e]];
    }
    for (std::size_t i = r.size(); i-- > 0;) {
      for (std::int32_t e = diagonal_[i] + 1; e < s_.start[i + 1]; ++e)
        z[i] -= lu_[e] * z[s_.column[e]];
      z[i] = (inverse_[i] * z[i]).eval();
    }
  }
  void multiply(const std::vector<Row>& x, std::vector<Row>& y) const {
    flow::for_blocks(x.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        y[i].setZero();
        for (std::int32_t e = s_.start[i]; e < s_.start[i + 1]; ++e)
          y[i] += k_[e] * x[s_.column[e]];
      }
    });
  }
  static double dot(const std::vector<Row>& a, const std::vector<Row>& b) {
    return flow::block_sum(a.size(), [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t i = begin; i < end; ++i) sum += a[i].dot(b[i]);
      return sum;
    });
  }
  static double norm(const std::vector<Row>& a) { return std::sqrt(dot(a, a)); }

  const flow::StokesSystem<3>& s_;
  std::vector<Block> k_, lu_, inverse_;
  std::vector<std::int32_t> diagonal_;
};

void compare(const std::string& name, const SimplexMesh<3>& mesh, bool with_reference) {
  FlowCase<3> flow;
  flow.gates = {{"gate", 1.0, {}}};
  flow.vents = {"vent"};
  std::printf("| %s | %zu |", name.c_str(), mesh.node_count());
  for (const bool smooth : {true, false}) {
    FlowSettings settings;
    settings.smooth_pressure = smooth;
    const double begin = now();
    const auto found = solve_stokes<3>(mesh, flow, settings);
    if (found)
      std::printf(" %zu | %.2f |", found->residuals.size() - 1, now() - begin);
    else
      std::printf(" none | %.2f |", now() - begin);
  }
  if (with_reference) {
    const auto system = flow::assemble<3>(mesh, flow, {});
    const double begin = now();
    Reference reference(*system);
    int iterations = 0;
    thread_arena(0).execute([&] { iterations = reference.solve(1e-8); });
    std::printf(iterations > 0 ? " %d | %.2f |\n" : " none in %d | %.2f |\n", std::abs(iterations),
                now() - begin);
  } else {
    std::printf(" | |\n");
  }
  std::fflush(stdout);
}

SimplexMesh<3> plate(int cells, double stretch) {
  auto mesh = box_mesh<3>({cells, cells, cells}, Vec<3>::Zero(), Vec<3>(stretch, stretch, 1));
  test::name_channel<3>(mesh);
  return mesh;
}

/// Flow along x through the mesh of a file.
SimplexMesh<3> from_file(const std::string& file) {
  auto mesh = read_medit<3>(file);
  if (!mesh) {
    std::fprintf(stderr, "%s\n", mesh.error().message.c_str());
    std::exit(1);
  }
  double low = 1e300, high = -1e300;
  for (std::size_t n = 1; n < mesh->points.size(); ++n) {
    low = std::min(low, mesh->points[n][0]);
    high = std::max(high, mesh->points[n][0]);
  }
  const double near = 1e-3 * (high - low);
  test::name_faces<3>(*mesh, [&](const Vec<3>& x) {
    return x[0] < low + near ? 1 : x[0] > high - near ? 2 : 0;
  });
  return std::move(*mesh);
}

}  // namespace
}  // namespace lamella

/// Without arguments the table of resources/docs/performance.md; with a .mesh, that mesh alone.
int main(int argc, char** argv) {
  using namespace lamella;
  std::printf("| mesh | nodes | iterations | s | without smoothing | s | CR + ILU(0) | s |\n");
  std::printf("|---|---|---|---|---|---|---|---|\n");
  for (int k = 1; k < argc; ++k) compare(argv[k], from_file(argv[k]), true);
  if (argc > 1) return 0;
  for (const int cells : {8, 16, 32})
    compare("channel 4 x 1 x 1, cubes", test::channel<3>(4, cells, 1), true);
  compare("the same", test::channel<3>(4, 52, 1), false);
  for (const int cells : {8, 16, 32}) compare("plate 50 x 50 x 1, 1:50", plate(cells, 50), true);
  for (const int cells : {8, 16, 32})
    compare("plate 100 x 100 x 1, 1:100", plate(cells, 100), true);
}
