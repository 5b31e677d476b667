#include "core/flow/stokes.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/flow_meshes.h"

namespace lamella {
namespace {

template <int D>
FlowCase<D> through() {
  FlowCase<D> flow;
  flow.gates = {{"gate", 1.0, {}}};
  flow.vents = {"vent"};
  return flow;
}

template <int D>
Flow<D> solved(const SimplexMesh<D>& mesh, const FlowCase<D>& flow,
               const FlowSettings& settings = {}) {
  Result<Flow<D>> found = solve_stokes<D>(mesh, flow, settings);
  EXPECT_TRUE(found.ok()) << (found.ok() ? "" : found.error().message);
  if (!found) return {};
  EXPECT_LT(found->imbalance, 1e-6);
  return std::move(*found);
}

struct Errors {
  double velocity = 0, pressure = 0;  ///< mean squares' roots, relative
};

/// Root of the mean square over the elements, by the vertices and the center.
template <int D, class Velocity, class Pressure>
Errors errors(const SimplexMesh<D>& mesh, const Flow<D>& flow, Velocity velocity,
              Pressure pressure) {
  double dv = 0, v2 = 0, dp = 0, p2 = 0;
  for (const auto& e : mesh.elements) {
    const double measure = std::abs(signed_measure<D>(mesh.corners(e)));
    Vec<D> x = Vec<D>::Zero(), v = Vec<D>::Zero();
    double p = 0;
    const auto add = [&](const Vec<D>& at, const Vec<D>& v_at, double p_at) {
      dv += measure * (v_at - velocity(at)).squaredNorm();
      v2 += measure * velocity(at).squaredNorm();
      dp += measure * std::pow(p_at - pressure(at), 2);
      p2 += measure * std::pow(pressure(at), 2);
    };
    for (const NodeId n : e) {
      x += mesh.points[n] / (D + 1);
      v += flow.velocity[n] / (D + 1);
      p += flow.pressure[n] / (D + 1);
      add(mesh.points[n], flow.velocity[n], flow.pressure[n]);
    }
    add(x, v, p);
  }
  return {std::sqrt(dv / v2), std::sqrt(dp / p2)};
}

double order(double coarse, double fine) { return std::log2(coarse / fine); }

TEST(Stokes, PlanarPoiseuilleConvergesOnStretchedElementsToo) {
  for (const double stretch : {1.0, 50.0}) {
    const double length = 2 * stretch;
    const auto velocity = [&](const Vec<2>& x) {
      return Vec<2>(x[1] * (1 - x[1]) / (2 * length), 0);
    };
    const auto pressure = [&](const Vec<2>& x) { return 1 - x[0] / length; };
    std::vector<Errors> found;
    for (const int cells : {4, 8, 16}) {
      const auto mesh = test::channel<2>(length, cells, stretch);
      found.push_back(errors<2>(mesh, solved<2>(mesh, through<2>()), velocity, pressure));
    }
    for (std::size_t k = 0; k + 1 < found.size(); ++k) {
      EXPECT_GT(order(found[k].velocity, found[k + 1].velocity), 1.8) << stretch;
      EXPECT_GT(order(found[k].pressure, found[k + 1].pressure), 0.9) << stretch;
    }
    EXPECT_LT(found.back().velocity, 0.01);
  }
}

TEST(Stokes, CylindricalPoiseuilleConvergesOnStretchedElementsToo) {
  for (const double stretch : {1.0, 50.0}) {
    const double length = 2 * stretch;
    const auto velocity = [&](const Vec<3>& x) {
      return Vec<3>(0, 0, std::max(0.0, 1 - x.head<2>().squaredNorm()) / (4 * length));
    };
    const auto pressure = [&](const Vec<3>& x) { return 1 - x[2] / length; };
    std::vector<Errors> found;
    for (const int cells : {4, 12}) {
      const auto mesh = test::cylinder(cells, cells, length);
      found.push_back(errors<3>(mesh, solved<3>(mesh, through<3>()), velocity, pressure));
    }
    EXPECT_GT(order(found[0].velocity, found[1].velocity), std::log2(3) * 1.8) << stretch;
    EXPECT_GT(order(found[0].pressure, found[1].pressure), std::log2(3) * 0.9) << stretch;
  }
}

/// Stream function x^2 (3 - x) y^2 (1 - y)^2, in 3D times z (1 - z), and a pressure such that the
/// vent x = 1 is free of eta dv/dn - p n: derivatives of the factors, by order.
struct Manufactured {
  static double f(double x, int k) {
    const std::array<double, 4> values = {x * x * (3 - x), 6 * x - 3 * x * x, 6 - 6 * x, -6};
    return values[k];
  }
  static double g(double y, int k) {
    const std::array<double, 4> values = {y * y * (1 - y) * (1 - y),
                                          2 * y - 6 * y * y + 4 * y * y * y,
                                          2 - 12 * y + 12 * y * y, -12 + 24 * y};
    return values[k];
  }
  template <int D>
  static double h(const Vec<D>& x, int k) {
    if constexpr (D == 2)
      return k == 0;
    else
      return k == 0 ? x[2] * (1 - x[2]) : k == 1 ? 1 - 2 * x[2] : -2.0;
  }
  template <int D>
  static Vec<D> velocity(const Vec<D>& x) {
    Vec<D> v = Vec<D>::Zero();
    v[0] = f(x[0], 0) * g(x[1], 1) * h<D>(x, 0);
    v[1] = -f(x[0], 1) * g(x[1], 0) * h<D>(x, 0);
    return v;
  }
  template <int D>
  static double pressure(const Vec<D>& x) {
    return f(x[0], 1) * g(x[1], 1) * h<D>(x, 0) + (1 - x[0]) * std::cos(2 * x[1]);
  }
  /// -lap v + grad p.
  template <int D>
  static Vec<D> force(const Vec<D>& x) {
    Vec<D> out = Vec<D>::Zero();
    const double z = h<D>(x, 0), zz = D == 2 ? 0 : h<D>(x, 2);
    out[0] = -(f(x[0], 2) * g(x[1], 1) * z + f(x[0], 0) * g(x[1], 3) * z +
               f(x[0], 0) * g(x[1], 1) * zz) +
             f(x[0], 2) * g(x[1], 1) * z - std::cos(2 * x[1]);
    out[1] = f(x[0], 3) * g(x[1], 0) * z + f(x[0], 1) * g(x[1], 2) * z +
             f(x[0], 1) * g(x[1], 0) * zz + f(x[0], 1) * g(x[1], 2) * z -
             2 * (1 - x[0]) * std::sin(2 * x[1]);
    if constexpr (D == 3) out[2] = f(x[0], 1) * g(x[1], 1) * h<D>(x, 1);
    return out;
  }
};

template <int D>
void expect_manufactured_orders(const std::vector<int>& cells) {
  FlowCase<D> flow;
  flow.vents = {"vent"};
  flow.body_force = [](const Vec<D>& x) { return Manufactured::force<D>(x); };
  std::vector<Errors> found;
  for (const int n : cells) {
    auto mesh = unit_box<D>(n);
    test::name_channel<D>(mesh);
    mesh.groups[1] = "another wall";
    const Flow<D> solution = [&] {
      Result<Flow<D>> r = solve_stokes<D>(mesh, flow);
      EXPECT_TRUE(r.ok()) << (r.ok() ? "" : r.error().message);
      return std::move(*r);
    }();
    found.push_back(errors<D>(
        mesh, solution, [](const Vec<D>& x) { return Manufactured::velocity<D>(x); },
        [](const Vec<D>& x) { return Manufactured::pressure<D>(x); }));
  }
  const double finer = std::log2(static_cast<double>(cells.back()) / cells.front());
  EXPECT_GT(order(found.front().velocity, found.back().velocity), 1.8 * finer);
  EXPECT_GT(order(found.front().pressure, found.back().pressure), 1.0 * finer);
}

TEST(Stokes, ManufacturedSolutionConverges2D) { expect_manufactured_orders<2>({8, 32}); }
TEST(Stokes, ManufacturedSolutionConverges3D) { expect_manufactured_orders<3>({6, 12}); }

TEST(Stokes, IterationsBarelyGrowWithNodesNorWithTheStretch) {
  for (const double stretch : {1.0, 50.0, 100.0}) {
    std::vector<double> iterations, nodes;
    for (const int cells : {8, 32}) {
      const auto mesh = test::channel<2>(2 * stretch, cells, stretch);
      iterations.push_back(static_cast<double>(solved<2>(mesh, through<2>()).residuals.size()));
      nodes.push_back(static_cast<double>(mesh.node_count()));
    }
    EXPECT_LT(std::log(iterations[1] / iterations[0]) / std::log(nodes[1] / nodes[0]), 0.4);
    EXPECT_LT(iterations[1], 60) << stretch;
  }
  // A plate, stretched in its plane: 1:50 and 1:100.
  for (const double stretch : {50.0, 100.0}) {
    auto mesh = box_mesh<3>({10, 10, 10}, Vec<3>::Zero(), Vec<3>(stretch, stretch, 1));
    test::name_channel<3>(mesh);
    EXPECT_LT(solved<3>(mesh, through<3>()).residuals.size(), 120u) << stretch;
  }
}

TEST(Stokes, LongThinCavitiesTakeNoMoreIterations) {
  const auto few = solved<2>(test::channel<2>(4, 6, 2), through<2>()).residuals.size();
  const auto many = solved<2>(test::channel<2>(400, 6, 2), through<2>()).residuals.size();
  EXPECT_LT(static_cast<double>(many), 1.5 * static_cast<double>(few));
}

TEST(Stokes, WithoutSmoothedPressureTheFlowIsNearlyTheSame) {
  const auto mesh = test::channel<3>(3, 6, 2);
  FlowSettings settings;
  settings.smooth_pressure = false;
  const auto plain = solved<3>(mesh, through<3>(), settings),
             smooth = solved<3>(mesh, through<3>());
  EXPECT_NEAR(plain.openings[1].rate, smooth.openings[1].rate, 1e-4 * plain.openings[1].rate);
}

/// A slit that turns the flow, so that nothing is parallel to anything.
SimplexMesh<3> bend() {
  auto mesh = l_shape<3>(3);
  test::name_faces<3>(mesh, [](const Vec<3>& x) {
    return x[0] > 2 - 1e-9 && x[1] < 1 ? 1 : x[1] > 2 - 1e-9 && x[0] < 1 ? 2 : 0;
  });
  return mesh;
}

TEST(Stokes, RotationTurnsTheFlowAndNothingElse) {
  const auto mesh = bend();
  const auto before = solved<3>(mesh, through<3>());
  const Mat<3> turn = (Eigen::AngleAxisd(0.7, Vec<3>(1, 2, 3).normalized())).toRotationMatrix();
  auto turned = mesh;
  for (Vec<3>& x : turned.points) x = turn * x + Vec<3>(5, -3, 2);
  const auto after = solved<3>(turned, through<3>());
  double largest = 0;
  for (const Vec<3>& v : before.velocity) largest = std::max(largest, v.norm());
  for (std::size_t n = 1; n < mesh.points.size(); ++n) {
    EXPECT_LT((after.velocity[n] - turn * before.velocity[n]).norm(), 1e-5 * largest);
    EXPECT_NEAR(after.pressure[n], before.pressure[n], 1e-5);
  }
  EXPECT_NEAR(after.openings[0].rate, before.openings[0].rate,
              1e-6 * std::abs(before.openings[0].rate));
}

TEST(Stokes, NumberingChangesNothing) {
  const auto mesh = bend();
  std::vector<NodeId> to(mesh.points.size());
  for (std::size_t n = 0; n < to.size(); ++n) to[n] = static_cast<NodeId>(n);
  std::mt19937 rng(3);
  std::shuffle(to.begin() + 1, to.end(), rng);
  auto other = mesh;
  for (std::size_t n = 0; n < to.size(); ++n) other.points[to[n]] = mesh.points[n];
  for (auto& e : other.elements)
    for (NodeId& n : e) n = to[n];
  for (auto& f : other.facets)
    for (NodeId& n : f) n = to[n];
  std::shuffle(other.elements.begin(), other.elements.end(), rng);
  const auto before = solved<3>(mesh, through<3>()), after = solved<3>(other, through<3>());
  for (std::size_t n = 1; n < mesh.points.size(); ++n)
    EXPECT_NEAR(after.pressure[to[n]], before.pressure[n], 1e-5);
  EXPECT_NEAR(after.openings[1].rate, before.openings[1].rate, 1e-6 * before.openings[1].rate);
}

TEST(Stokes, ThreadsChangeNotOneBit) {
  const auto mesh = test::channel<3>(4, 12, 1.5);
  FlowSettings one, two;
  one.threads = 1;
  two.threads = 2;
  const auto a = solved<3>(mesh, through<3>(), one), b = solved<3>(mesh, through<3>(), two);
  EXPECT_EQ(a.velocity, b.velocity);
  EXPECT_EQ(a.pressure, b.pressure);
  EXPECT_EQ(a.residuals, b.residuals);
}

TEST(Stokes, HalfAChannelAlongAnObliqueSymmetryIsHalfTheChannel) {
  const Eigen::Rotation2Dd turn(0.4);
  auto whole = test::channel<2>(2, 16, 1);
  auto half = box_mesh<2>({32, 8}, Vec<2>(0, 0.5), Vec<2>(2, 1));
  test::name_channel<2>(half, {2});
  for (Vec<2>& x : half.points) x = turn * x;
  FlowCase<2> flow = through<2>();
  const double all = solved<2>(whole, flow).openings[1].rate;
  flow.symmetries = {"symmetry"};
  const auto found = solved<2>(half, flow);
  EXPECT_NEAR(found.openings[1].rate, 0.5 * all, 2e-3 * all);
  for (std::size_t n = 1; n < half.points.size(); ++n) {
    const Vec<2> x = turn.inverse() * half.points[n], v = turn.inverse() * found.velocity[n];
    EXPECT_NEAR(v[0], x[1] * (1 - x[1]) / 4, 2e-3);
    if (std::abs(x[1] - 0.5) < 1e-9) {
      EXPECT_NEAR(v[1], 0, 1e-14);
    }
  }
}

// The mesh of the duct is its own image in the diagonal plane, so the flow through half of it is
// the same to rounding. The diagonal meets the symmetry y = 0 at 45 degrees.
TEST(Stokes, SymmetriesMayMeetAtAnyAngle) {
  const auto group = [](const Vec<3>& x) {
    if (x[2] < 1e-9) return 1;
    if (x[2] > 3 - 1e-9) return 2;
    return x[0] < 1e-9 || x[1] < 1e-9 || std::abs(x[0] - x[1]) < 1e-9 ? 3 : 0;
  };
  auto quarter = box_mesh<3>({5, 5, 6}, Vec<3>::Zero(), Vec<3>(1, 1, 3));
  auto eighth = quarter;
  std::erase_if(eighth.elements, [&](const auto& e) {
    Vec<3> center = Vec<3>::Zero();
    for (const NodeId n : e) center += quarter.points[n];
    return center[1] > center[0];
  });
  eighth.element_body.resize(eighth.elements.size());
  test::name_faces<3>(quarter, group);
  test::name_faces<3>(eighth, group);
  FlowCase<3> flow = through<3>();
  flow.symmetries = {"symmetry"};
  const auto a = solved<3>(quarter, flow), b = solved<3>(eighth, flow);
  EXPECT_NEAR(b.openings[1].rate, 0.5 * a.openings[1].rate, 1e-5 * a.openings[1].rate);
  for (const auto& e : eighth.elements)
    for (const NodeId n : e) EXPECT_LT((a.velocity[n] - b.velocity[n]).norm(), 1e-5);
}

TEST(Stokes, RatesAreMetAndGatesSeeOneAnotherAlike) {
  auto mesh = bend();
  mesh.groups.push_back("side");
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    Vec<3> center = Vec<3>::Zero();
    for (const NodeId n : mesh.facets[f]) center += mesh.points[n] / 3;
    if (center[0] < 1e-9 && center[1] < 1) mesh.facet_group[f] = 4;
  }
  FlowCase<3> flow;
  flow.viscosity = 3;
  flow.vents = {"vent"};
  // The rate that one gate draws from the other is the same both ways.
  flow.gates = {{"gate", 1.0, {}}, {"side", 0.0, {}}};
  const double drawn = solved<3>(mesh, flow).openings[1].rate;
  flow.gates = {{"gate", 0.0, {}}, {"side", 1.0, {}}};
  EXPECT_NEAR(solved<3>(mesh, flow).openings[0].rate, drawn, 1e-5 * std::abs(drawn));

  flow.gates = {{"gate", {}, 2.0}, {"side", {}, 0.5}};
  const auto asked = solved<3>(mesh, flow);
  EXPECT_NEAR(asked.openings[0].rate, -2, 1e-6);
  EXPECT_NEAR(asked.openings[1].rate, -0.5, 1e-6);
  EXPECT_NEAR(asked.openings[2].rate, 2.5, 1e-6);
  // The pressures that were found give the same flow.
  flow.gates = {{"gate", asked.openings[0].pressure, {}}, {"side", asked.openings[1].pressure, {}}};
  const auto again = solved<3>(mesh, flow);
  EXPECT_NEAR(again.openings[0].rate, -2, 1e-5);
  EXPECT_NEAR(again.openings[1].rate, -0.5, 1e-5);
}

TEST(Stokes, WhatCannotBeSolvedIsToldInASentence) {
  const auto mesh = test::channel<2>(2, 4, 1);
  const auto code = [&](const FlowCase<2>& flow, const FlowSettings& settings = {}) {
    const Result<Flow<2>> r = solve_stokes<2>(mesh, flow, settings);
    EXPECT_FALSE(r.ok());
    EXPECT_FALSE(r.error().message.empty());
    return r.error().code;
  };
  FlowCase<2> flow = through<2>();
  flow.vents = {};
  EXPECT_EQ(code(flow), Code::usage);
  flow.vents = {"nowhere"};
  EXPECT_EQ(code(flow), Code::usage);
  flow.vents = {"gate"};
  EXPECT_EQ(code(flow), Code::usage);
  flow.vents = {"symmetry"};  // a group without a face
  EXPECT_EQ(code(flow), Code::bad_input);
  flow = through<2>();
  flow.gates[0].rate = 1;
  EXPECT_EQ(code(flow), Code::usage);
  flow = through<2>();
  flow.viscosity = 0;
  EXPECT_EQ(code(flow), Code::usage);
  FlowSettings hasty;
  hasty.most_iterations = 3;
  EXPECT_EQ(code(through<2>(), hasty), Code::not_converged);

  auto apart = mesh;  // a second part that no opening belongs to
  const auto far = static_cast<NodeId>(apart.points.size());
  apart.points.insert(apart.points.end(), {Vec<2>(9, 0), Vec<2>(10, 0), Vec<2>(9, 1)});
  apart.elements.push_back({far, far + 1, far + 2});
  apart.element_body.push_back(0);
  const auto refused = solve_stokes<2>(apart, through<2>());
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, Code::bad_input);

  auto flat = mesh;
  flat.points.push_back(flat.points[flat.elements[0][0]]);
  flat.elements.push_back(
      {flat.elements[0][0], flat.elements[0][1], static_cast<NodeId>(flat.points.size() - 1)});
  flat.element_body.push_back(0);
  const auto refused_flat = solve_stokes<2>(flat, through<2>());
  ASSERT_FALSE(refused_flat.ok());
  EXPECT_EQ(refused_flat.error().code, Code::bad_input);
}

TEST(Stokes, CancelIsHeard) {
  const auto mesh = test::channel<3>(4, 8, 1);
  std::stop_source stop;
  double seen = 0;
  const auto sink = [&](double fraction, std::string_view) {
    EXPECT_GE(fraction, seen);
    seen = fraction;
    if (fraction > 0.5) stop.request_stop();
  };
  const auto r = solve_stokes<3>(mesh, through<3>(), {}, Progress(sink, stop.get_token()));
  ASSERT_FALSE(r.ok());
  EXPECT_EQ(r.error().code, Code::cancelled);
  EXPECT_LT(seen, 1);
}

// Nodes that no element uses and faces between bodies are not walls.
TEST(Stokes, FacesWithinTheMeshDoNotStopTheFlow) {
  auto mesh = test::channel<2>(2, 8, 1);
  const auto before = solved<2>(mesh, through<2>());
  mesh.points.push_back(Vec<2>(100, 100));
  std::vector<SimplexMesh<2>::Facet> inside;
  for (const auto& e : mesh.elements)
    if (mesh.points[e[0]][1] == 0.5 && mesh.points[e[1]][1] == 0.5) inside.push_back({e[0], e[1]});
  ASSERT_FALSE(inside.empty());
  for (const auto& f : inside) {
    mesh.facets.push_back(f);
    mesh.facet_group.push_back(0);
    mesh.facet_face.push_back(9);
  }
  const auto after = solved<2>(mesh, through<2>());
  EXPECT_EQ(after.openings[1].rate, before.openings[1].rate);
  EXPECT_EQ(after.velocity.back(), Vec<2>(0, 0));
}

}  // namespace
}  // namespace lamella
