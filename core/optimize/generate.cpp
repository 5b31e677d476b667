#include "core/optimize/generate.h"

#include <time.h>

#include <chrono>
#include <limits>
#include <optional>
#include <sstream>

#include "core/geometry/self_intersection.h"
#include "core/optimize/certificate.h"
#include "core/optimize/generate_peel.h"
#include "core/optimize/generate_star.h"
#include "core/optimize/generate_voids.h"

namespace lamella {
namespace {

constexpr int kAttempts = 6;
constexpr double kShareOfVoid = 1.0 / 60;  // of the time limit, for each void

/// Processor time of this thread: what else the machine does must not decide which attempt ends.
struct Clock {
  using duration = std::chrono::nanoseconds;
  using time_point = std::chrono::time_point<Clock, duration>;
  static time_point now() {
    timespec t{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return time_point(std::chrono::seconds(t.tv_sec) + std::chrono::nanoseconds(t.tv_nsec));
  }
};

/// Deterministic on every platform, unlike the distributions of <random>.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ull);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
  }
  template <class T>
  void shuffle(std::vector<T>& v) {
    for (std::size_t i = v.size(); i > 1; --i) std::swap(v[i - 1], v[next() % i]);
  }

 private:
  std::uint64_t state_;
};

/// One run of algorithm 2.1 from one apex and in one order of nodes.
///
/// The probes are the fast engine on what is still inverted: from each bad element a cavity grows
/// until a node near by sees its whole boundary. The sweeps are the thesis' own: every node and
/// edge of the bad zone, and of some rings around it, with all candidates; good cavities too, since
/// the bad ones otherwise freeze among them. Effort rises only while nothing cheaper pays.
template <int D>
class Attempt {
 public:
  Attempt(const Bridged<D>& boundary, const ReferenceSurface<D>& surface, std::uint64_t seed,
          Clock::time_point deadline, const Progress& progress)
      : mesh_(surface), star_(mesh_), random_(seed), deadline_(deadline), progress_(progress) {
    boundary_ = &boundary;
  }

  /// True when no element is inverted or flat. With the surface in `peeled` it is peeled before
  /// the rest is starred (3D), and the apex is a new node.
  bool run(NodeId apex, const Locator<3>* peeled) {
    constexpr double kPays = 0.05;  // share of the trouble a pass must remove
    constexpr int kFruitless = 12;  // passes without any gain before giving up
    start(apex, peeled);
    const double first = mesh_.bad_count();
    double least = star_.inverted_volume();
    int fewest = mesh_.bad_count(), effort = 0, fruitless = 0;
    for (int pass = 0; mesh_.bad_count() && !late(); ++pass) {
      if (effort > 0) sweep(std::min(effort - 1, 2), pass % 2 == 1);
      probe(60 << (2 * std::min(effort, 3)), effort < 2);
      const double inverted = star_.inverted_volume();
      const int bad = mesh_.bad_count();
      progress_.report(1 - bad / first);
      const bool paid = inverted < (1 - kPays) * least || bad < (1 - kPays) * fewest;
      fruitless = inverted < least || bad < fewest ? 0 : fruitless + 1;
      least = std::min(least, inverted);
      fewest = std::min(fewest, bad);
      if (paid) {
        effort = std::max(0, effort - 1);
      } else if (++effort > 4) {
        if (fruitless >= kFruitless) return false;
        restar_zones(1 + fruitless % 2);
        effort = 2;
      }
    }
    return mesh_.bad_count() == 0;
  }

  /// What (2.20) exceeds the domain by; `where` gets the middle of the worst element.
  double excess(Vec<D>* where) const { return 2 * star_.inverted_volume(where); }
  const FoldedMesh<D>& mesh() const { return mesh_; }

 private:
  static constexpr int kHub = 200;  // nodes of more elements than this tie far places together

  void start(NodeId apex, const Locator<3>* peeled) {
    if constexpr (D == 3)
      if (peeled)
        return star_.start(
            peel(*boundary_, mesh_, *peeled, random_.next(), progress_.portion(0, 0.2)), 0);
    star_.start(*boundary_, apex);
  }

  bool late() const { return progress_.cancelled() || Clock::now() > deadline_; }

  std::vector<int> bad_elements() const {
    std::vector<int> bad;
    for (int e = 0; e < mesh_.element_end(); ++e)
      if (mesh_.alive(e) && mesh_.bad(e)) bad.push_back(e);
    return bad;
  }

  void sweep(int rings, bool shuffled) {
    std::vector<NodeId> zone;
    std::vector<char> in_zone(mesh_.node_end(), 0);
    const auto add = [&](NodeId n) {
      if (!in_zone[n]) zone.push_back(n);
      in_zone[n] = 1;
    };
    for (const int e : bad_elements())
      for (const NodeId n : mesh_.element(e)) add(n);
    for (std::size_t begin = 0, end = zone.size(); rings > 0; --rings) {
      for (std::size_t i = begin; i < end; ++i)
        if (mesh_.degree(zone[i]) <= kHub)
          for (const int e : mesh_.around(zone[i]))
            for (const NodeId n : mesh_.element(e)) add(n);
      begin = end;
      end = zone.size();
    }
    std::sort(zone.begin(), zone.end());
    if (shuffled) random_.shuffle(zone);
    for (const NodeId n : zone) {
      if (late()) return;
      star_.improve_node(n);
      if (mesh_.degree(n) > kHub) continue;
      std::vector<NodeId> mates = star_.neighbors(n);
      std::sort(mates.begin(), mates.end());
      for (const NodeId m : mates) {
        // An edge inside the zone is met twice: the lower end takes it.
        const bool inside = m < static_cast<NodeId>(in_zone.size()) && in_zone[m];
        if (m > n || !inside) star_.improve_edge(n, m);
      }
    }
  }

  void probe(int limit, bool strict) {
    std::vector<NodeId> apexes;
    for (const int b : bad_elements()) {
      if (late()) return;
      if (!mesh_.alive(b) || !mesh_.bad(b)) continue;
      apexes.clear();
      for (const NodeId n : mesh_.element(b)) {
        apexes.push_back(n);
        if (mesh_.degree(n) > kHub) continue;
        const auto& near = star_.neighbors(n);
        apexes.insert(apexes.end(), near.begin(), near.end());
      }
      std::sort(apexes.begin(), apexes.end());
      apexes.erase(std::unique(apexes.begin(), apexes.end()), apexes.end());
      random_.shuffle(apexes);
      for (const NodeId a : apexes)
        if (star_.improve_seen_from(b, a, limit, strict)) break;
    }
  }

  /// Shakes the stalled zones: the region around each bad element is starred from one of its nodes,
  /// without asking for improvement.
  void restar_zones(int layers) {
    constexpr std::size_t kLargest = 400;
    std::vector<char> seen;
    std::vector<int> region;
    for (const int b : bad_elements()) {
      if (late()) return;
      if (!mesh_.alive(b) || !mesh_.bad(b)) continue;
      seen.resize(mesh_.element_end(), 0);
      region.assign(1, b);
      seen[b] = 1;
      for (std::size_t begin = 0, end = 1, l = 0; static_cast<int>(l) < layers; ++l) {
        for (std::size_t i = begin; i < end && region.size() < kLargest; ++i)
          for (const NodeId n : mesh_.element(region[i]))
            if (mesh_.degree(n) <= kHub)
              for (const int e : mesh_.around(n))
                if (!seen[e]) seen[e] = 1, region.push_back(e);
        begin = end;
        end = region.size();
      }
      for (const int e : region) seen[e] = 0;
      if (region.size() < kLargest) star_.restar(region);
    }
  }

  FoldedMesh<D> mesh_;
  StarOperator<D> star_;
  Random random_;
  Clock::time_point deadline_;
  Progress progress_;
  const Bridged<D>* boundary_;
};

template <int D>
SimplexMesh<D> to_mesh(const FoldedMesh<D>& t, const ReferenceSurface<D>& surface) {
  SimplexMesh<D> mesh;
  const auto surface_nodes = static_cast<NodeId>(surface.points.size());
  std::vector<NodeId> number(t.node_end(), 0);
  for (NodeId n = 1; n < t.node_end(); ++n) {
    if (n > surface_nodes && t.degree(n) == 0) continue;
    number[n] = static_cast<NodeId>(mesh.points.size());
    mesh.points.push_back(t.point(n));
  }
  for (int i = 0; i < t.element_end(); ++i) {
    if (!t.alive(i)) continue;
    auto e = t.element(i);
    for (auto& n : e) n = number[n];
    mesh.elements.push_back(e);
  }
  mesh.element_body.assign(mesh.elements.size(), 0);
  for (auto f : surface.facets) {
    for (auto& n : f) ++n;
    mesh.facets.push_back(f);
  }
  mesh.facet_group.assign(mesh.facets.size(), 0);
  mesh.facet_face = surface.facet_face;
  return mesh;
}

/// The order of the nodes decides whether a hard surface stalls: several attempts, the first from
/// the middle of the body, the others from nodes of the surface as in the thesis.
template <int D>
Result<SimplexMesh<D>> portfolio(const ReferenceSurface<D>& surface, std::uint64_t seed,
                                 int attempts, Clock::duration time, const Progress& progress) {
  const Bridged<D> boundary = bridge_shells<D>(surface);
  Random random(seed);
  std::optional<Locator<3>> locator;
  if constexpr (D == 3) locator.emplace(surface);
  const auto deadline = Clock::now() + time;
  double least = std::numeric_limits<double>::infinity();
  Error stalled{Code::failed, "Algorithm 2.1 was given no time.", "Raise its time limit."};
  for (int attempt = 0; attempt < attempts; ++attempt) {
    if (progress.cancelled()) return cancelled_error();
    const auto now = Clock::now();
    if (now >= deadline) break;
    const auto& start = surface.facets[random.next() % surface.facets.size()];
    const NodeId apex = attempt == 0 ? 0 : start[0] + 1;
    // The first attempt is the best; of what is left half each, so that a slow stall does not use
    // up the others' time.
    const auto share = attempt == 0 ? 3 * (deadline - now) / 4 : (deadline - now) / 2;
    const auto until = attempt + 1 == attempts ? deadline : now + share;
    Attempt<D> work(boundary, surface, random.next(), until, progress);
    if (work.run(apex, attempt % 2 == 0 && locator ? &*locator : nullptr)) {
      SimplexMesh<D> mesh = to_mesh(work.mesh(), surface);
      if (auto valid = certify<D>(mesh, surface); valid.ok())
        return mesh;
      else
        stalled = valid.error();
      continue;
    }
    if (progress.cancelled()) return cancelled_error();
    Vec<D> where = Vec<D>::Zero();
    const double excess = work.excess(&where);
    if (excess >= least) continue;
    least = excess;
    std::ostringstream s;
    s << "Algorithm 2.1 stalled with an excess volume of " << excess << " mm^" << D << " in "
      << work.mesh().bad_count() << " inverted or flat elements, the worst near (";
    for (int k = 0; k < D; ++k) s << (k ? ", " : "") << where[k];
    s << ").";
    stalled = {Code::failed, s.str(), "Another seed, more time or a finer surface may succeed."};
  }
  return stalled;
}

}  // namespace

template <int D>
Result<SimplexMesh<D>> generate(const ReferenceSurface<D>& surface, const GenerateParams& params,
                                const Progress& progress) {
  if (auto closed = check_boundary<D>(surface); !closed) return closed.error();
  if (domain_measure<D>(surface) <= 0)
    return Error{Code::bad_input, "The surface is wound inside out.", "Turn its facets."};
  if constexpr (D == 3) {
    // The certificate takes the surface for a mesh of the boundary: one that crosses itself would
    // be filled twice where it overlaps, with every volume in order.
    if (const SelfIntersections x = find_self_intersections(surface, progress); x.pairs > 0) {
      std::ostringstream s;
      s << "The surface crosses itself in " << x.pairs << " pairs of facets, the first near ("
        << x.place[0] << ", " << x.place[1] << ", " << x.place[2] << ").";
      return Error{Code::failed, s.str(), "A finer chord tolerance may set the facets apart."};
    }
  }
  if (progress.cancelled()) return cancelled_error();
  const auto clock_time = [](double t) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(t));
  };
  if constexpr (D == 3) {
    std::vector<int> shell;
    if (const int shells = number_shells<3>(surface.facets, shell); shells > 1) {
      const auto until =
          Clock::now() + clock_time(params.time_limit * (0.5 + kShareOfVoid * shells));
      const FillSurface fill = [&](const ReferenceSurface<3>& part, int attempts,
                                   const Progress& inner) {
        return portfolio<3>(part, params.seed, attempts, until - Clock::now(), inner);
      };
      Result<SimplexMesh<3>> mesh = generate_around_voids(surface, fill, progress.portion(0, 0.5));
      if (!mesh && mesh.error().code == Code::cancelled) return mesh;
      if (mesh && certify<3>(*mesh, surface).ok()) return mesh;
    }
  }
  return portfolio<D>(surface, params.seed, kAttempts, clock_time(params.time_limit), progress);
}

namespace {

class TopologicalMesher final : public VolumeMesher {
 public:
  explicit TopologicalMesher(const GenerateParams& params) : params_(params) {}
  std::string name() const override { return "algorithm 2.1"; }
  Result<SimplexMesh<3>> generate(const ReferenceSurface<3>& surface,
                                  const Progress& progress) const override {
    return lamella::generate<3>(surface, params_, progress);
  }

 private:
  GenerateParams params_;
};

}  // namespace

std::unique_ptr<VolumeMesher> topological_mesher(const GenerateParams& params) {
  return std::make_unique<TopologicalMesher>(params);
}

template Result<SimplexMesh<2>> generate<2>(const ReferenceSurface<2>&, const GenerateParams&,
                                            const Progress&);
template Result<SimplexMesh<3>> generate<3>(const ReferenceSurface<3>&, const GenerateParams&,
                                            const Progress&);
template Result<SimplexMesh<4>> generate<4>(const ReferenceSurface<4>&, const GenerateParams&,
                                            const Progress&);

}  // namespace lamella
