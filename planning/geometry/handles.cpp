#include "planning/geometry/handles.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <tuple>
#include <utility>

namespace arthronaut::geometry {

namespace {

constexpr double kMostWork = 2.5e6;  // handles times triangles; see the header

using Eigen::Vector3d;
using Index = std::int32_t;

std::size_t at(Index index) { return static_cast<std::size_t>(index); }

struct Edge {
  Index low = 0, high = 0;                    // vertices
  std::array<Index, 2> triangles = {-1, -1};  // on either side
};

// Which sets have been joined.
class Union {
 public:
  explicit Union(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  Index find(Index one) {
    while (parent_[at(one)] != one) one = parent_[at(one)] = parent_[at(parent_[at(one)])];
    return one;
  }
  bool join(Index a, Index b) {
    a = find(a), b = find(b);
    parent_[at(a)] = b;
    return a != b;
  }

 private:
  std::vector<Index> parent_;
};

// Empty where an edge is not of two triangles that run along it either way.
std::vector<Edge> edges_of(const TriangleMesh& mesh) {
  struct Side {
    Index low, high, triangle;
    bool runs_up;
  };
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), static_cast<Index>(t), a < b});
    }
  std::ranges::sort(sides, [](const Side& l, const Side& r) {
    return std::tie(l.low, l.high, l.runs_up) < std::tie(r.low, r.high, r.runs_up);
  });
  if (sides.size() % 2 != 0) return {};
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < sides.size(); i += 2) {
    const Side &one = sides[i], &other = sides[i + 1];
    const bool is_pair = one.low == other.low && one.high == other.high && one.runs_up != other.runs_up;
    const bool is_third = i > 0 && sides[i - 1].low == one.low && sides[i - 1].high == one.high;
    if (!is_pair || is_third || one.low == one.high) return {};
    edges.push_back({one.low, one.high, {other.triangle, one.triangle}});
  }
  return edges;
}

// Shortest ways along edges from one vertex, and the loops that they close with each other about handles.
class Loops {
 public:
  Loops(const TriangleMesh& mesh, const std::vector<Edge>& edges) : mesh_(mesh), edges_(edges) {
    begins_.resize(mesh.vertices_mm.size() + 1);
    for (const Edge& edge : edges) ++begins_[at(edge.low) + 1], ++begins_[at(edge.high) + 1];
    std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
    ends_.resize(2 * edges.size());
    std::vector<std::size_t> next(begins_.begin(), begins_.end() - 1);
    for (const Edge& edge : edges) {
      const double length = (mesh.vertices_mm[at(edge.low)] - mesh.vertices_mm[at(edge.high)]).norm();
      ends_[next[at(edge.low)]++] = {edge.high, length};
      ends_[next[at(edge.high)]++] = {edge.low, length};
    }
  }

  struct Loop {
    double around_mm = std::numeric_limits<double>::infinity();
    std::vector<Index> vertices;
  };
  // Two for every handle of the part that the vertex is of (Erickson and Whittlesey 2005): edges that are
  // neither on a shortest way nor crossed by the tree that joins the triangles between these ways, the longer
  // loops being crossed first. Without the way to and fro.
  [[nodiscard]] std::vector<Loop> about(Index root) {
    find_ways(root);
    std::vector<std::pair<double, std::size_t>> open;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const Edge& edge = edges_[e];
      if (before_[at(edge.low)] == edge.high || before_[at(edge.high)] == edge.low) continue;
      const double length = (mesh_.vertices_mm[at(edge.low)] - mesh_.vertices_mm[at(edge.high)]).norm();
      open.emplace_back(way_mm_[at(edge.low)] + way_mm_[at(edge.high)] + length, e);
    }
    std::ranges::sort(open, std::greater<>());
    Union joined(mesh_.triangles.size());
    std::vector<Loop> loops;
    for (const auto& [length, e] : open) {
      const Edge& edge = edges_[e];
      if (!joined.join(edge.triangles[0], edge.triangles[1]) && before_[at(edge.low)] != kNotReached)
        loops.push_back(closed(edge));
    }
    return loops;
  }

 private:
  static constexpr Index kNotReached = -2, kRoot = -1;

  void find_ways(Index root) {
    way_mm_.assign(mesh_.vertices_mm.size(), std::numeric_limits<double>::infinity());
    before_.assign(mesh_.vertices_mm.size(), kNotReached);
    std::priority_queue<std::pair<double, Index>, std::vector<std::pair<double, Index>>, std::greater<>> open;
    way_mm_[at(root)] = 0;
    before_[at(root)] = kRoot;
    open.emplace(0.0, root);
    while (!open.empty()) {
      const auto [way, from] = open.top();
      open.pop();
      if (way > way_mm_[at(from)]) continue;
      for (std::size_t i = begins_[at(from)]; i < begins_[at(from) + 1]; ++i) {
        const auto& [to, length] = ends_[i];
        if (way + length >= way_mm_[at(to)]) continue;
        way_mm_[at(to)] = way + length;
        before_[at(to)] = from;
        open.emplace(way + length, to);
      }
    }
  }

  [[nodiscard]] Loop closed(const Edge& edge) const {
    const auto way_to = [&](Index vertex) {
      std::vector<Index> way;
      for (; vertex >= 0; vertex = before_[at(vertex)]) way.push_back(vertex);
      return way;
    };
    std::vector<Index> one = way_to(edge.low), other = way_to(edge.high);
    while (one.size() > 1 && other.size() > 1 && one[one.size() - 2] == other[other.size() - 2])
      one.pop_back(), other.pop_back();
    other.pop_back();  // where they part is in both
    one.insert(one.end(), other.rbegin(), other.rend());
    double around_mm = 0;
    for (std::size_t i = 0; i < one.size(); ++i)
      around_mm += (mesh_.vertices_mm[at(one[i])] - mesh_.vertices_mm[at(one[(i + 1) % one.size()])]).norm();
    return {around_mm, std::move(one)};
  }

  const TriangleMesh& mesh_;
  const std::vector<Edge>& edges_;
  std::vector<std::size_t> begins_;
  std::vector<std::pair<Index, double>> ends_;
  std::vector<double> way_mm_;
  std::vector<Index> before_;
};

// Cuts the surface along a simple loop and closes both rims: one handle less.
void cut_and_close(TriangleMesh& mesh, const std::vector<Edge>& edges, const std::vector<Index>& loop) {
  std::vector<Index> place(mesh.vertices_mm.size(), -1);
  for (std::size_t i = 0; i < loop.size(); ++i) place[at(loop[i])] = static_cast<Index>(i);
  const auto is_of_loop = [&](Index a, Index b) {
    const Index i = place[at(a)], j = place[at(b)], count = static_cast<Index>(loop.size());
    return i >= 0 && j >= 0 && ((i + 1) % count == j || (j + 1) % count == i);
  };
  // Triangles at the loop are on one side of it where they are joined across edges that are not the loop's
  // and have a vertex on it.
  Union side(mesh.triangles.size());
  for (const Edge& edge : edges)
    if ((place[at(edge.low)] >= 0 || place[at(edge.high)] >= 0) && !is_of_loop(edge.low, edge.high))
      side.join(edge.triangles[0], edge.triangles[1]);
  // The first rim's side: of the triangle that runs along the loop as it was given.
  Index on_first = -1;
  for (std::size_t t = 0; t < mesh.triangles.size() && on_first < 0; ++t)
    for (std::size_t k = 0; k < 3; ++k)
      if (mesh.triangles[t][k] == loop[0] && mesh.triangles[t][(k + 1) % 3] == loop[1])
        on_first = side.find(static_cast<Index>(t));
  const auto first_new = static_cast<Index>(mesh.vertices_mm.size());
  Vector3d middle = Vector3d::Zero();
  for (const Index v : loop) {
    mesh.vertices_mm.push_back(mesh.vertices_mm[at(v)]);
    middle += mesh.vertices_mm[at(v)] / static_cast<double>(loop.size());
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (side.find(static_cast<Index>(t)) != on_first) continue;
    for (Index& v : mesh.triangles[t])
      if (v < first_new && place[at(v)] >= 0) v = first_new + place[at(v)];
  }
  const auto count = static_cast<Index>(loop.size());
  const Index of_first = first_new + count, of_second = of_first + 1;
  mesh.vertices_mm.push_back(middle);
  mesh.vertices_mm.push_back(middle);
  for (Index i = 0; i < count; ++i) {
    const Index j = (i + 1) % count;
    mesh.triangles.push_back({first_new + j, first_new + i, of_first});
    mesh.triangles.push_back({loop[at(i)], loop[at(j)], of_second});
  }
}

// Of all parts together: 0 for one that is like a ball.
int genus(const TriangleMesh& mesh, const std::vector<Edge>& edges) {
  Union parts(mesh.vertices_mm.size());
  for (const Edge& edge : edges) (void)parts.join(edge.low, edge.high);
  std::vector<bool> is_used(mesh.vertices_mm.size(), false);
  for (const Edge& edge : edges) is_used[at(edge.low)] = is_used[at(edge.high)] = true;
  std::ptrdiff_t vertices = 0, count = 0;
  for (std::size_t v = 0; v < is_used.size(); ++v) {
    if (!is_used[v]) continue;
    ++vertices;
    if (parts.find(static_cast<Index>(v)) == static_cast<Index>(v)) ++count;
  }
  const std::ptrdiff_t euler = vertices - static_cast<std::ptrdiff_t>(edges.size()) +
                               static_cast<std::ptrdiff_t>(mesh.triangles.size());
  return static_cast<int>((2 * count - euler) / 2);
}

}  // namespace

std::vector<Handle> handles_of(const TriangleMesh& mesh, double least_around_mm) {
  TriangleMesh left = mesh;
  std::vector<Handle> handles;
  while (true) {
    const std::vector<Edge> edges = edges_of(left);
    const int count = edges.empty() ? 0 : genus(left, edges);
    if (count <= 0) return handles;
    // Each costs some ten walks over the whole surface.
    if (static_cast<double>(count) * static_cast<double>(left.triangles.size()) > kMostWork) return {};
    Loops loops(left, edges);
    Loops::Loop shortest;
    Union parts(left.vertices_mm.size());
    for (const Edge& edge : edges) (void)parts.join(edge.low, edge.high);
    std::vector<bool> is_seen(left.vertices_mm.size(), false);
    for (const Edge& edge : edges) {
      const Index part = parts.find(edge.low);
      if (is_seen[at(part)]) continue;
      is_seen[at(part)] = true;
      for (Loops::Loop& loop : loops.about(edge.low))
        if (loop.around_mm < shortest.around_mm) shortest = std::move(loop);
    }
    // From a place of its own a loop is shorter than as it was seen from afar.
    for (double before_mm = std::numeric_limits<double>::infinity(); shortest.around_mm < before_mm - 0.01;) {
      before_mm = shortest.around_mm;
      const std::vector<Index> seen_from = shortest.vertices;
      for (std::size_t quarter = 0; quarter < 4; ++quarter)
        for (Loops::Loop& loop : loops.about(seen_from[quarter * seen_from.size() / 4]))
          if (loop.around_mm < shortest.around_mm) shortest = std::move(loop);
    }
    if (shortest.vertices.size() < 3) return handles;
    if (shortest.around_mm >= least_around_mm) {
      Handle handle{shortest.around_mm, {}};
      for (const Index v : shortest.vertices) handle.line_mm.push_back(left.vertices_mm[at(v)]);
      handles.push_back(std::move(handle));
    }
    cut_and_close(left, edges, shortest.vertices);
  }
}

}  // namespace arthronaut::geometry
