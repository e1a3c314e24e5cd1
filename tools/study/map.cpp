// Study kind "map": finds the curve in the plane of two variables on which an expression is zero.
//
// First the expression is evaluated on a grid. From every crossing of a grid line the curve is followed in both directions: a step along
// the tangent, then a search across it.
#include "tools/study/kinds.h"

#include "tools/study/crossing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace steplap::study {

namespace {

/// Settings of a "map" study.
struct MapSettings : KindSettings {
  std::vector<std::string> variables; ///< names of the two variables
  std::string expression;             ///< expression whose zeros form the curve
  double step = 0.02;                 ///< step along the curve, relative to the ranges
  long points = 11;                   ///< number of points per side of the first grid
  double tolerance = 1e-9;
  bool is_logarithmic = false;
};

FieldTable map_fields() {
  using S = MapSettings;
  FieldTable t;
  t.add("variables", &S::variables).required().doc("two variables with ranges");
  t.add("expression", &S::expression).required().doc("of responses and variables: the border is where it is zero");
  t.add("step", &S::step).at_least(1e-4).at_most(0.2).doc("along the border, of the ranges");
  t.add("points", &S::points).at_least(3).at_most(1000).doc("a side, of the first look: smaller islands are not seen");
  t.add("tolerance", &S::tolerance).positive().at_most(0.01).doc("of the border's points, of the ranges");
  t.add("logarithmic", &S::is_logarithmic).doc("ranges are divided by ratios");
  return t;
}

using Point = std::array<double, 2>; ///< values of both variables, scaled by their ranges to [0, 1]

Point along(const Point& p, const Point& direction, double s) { return {p[0] + s * direction[0], p[1] + s * direction[1]}; }
double distance(const Point& a, const Point& b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }
bool is_inside(const Point& p) { return p[0] >= 0.0 && p[0] <= 1.0 && p[1] >= 0.0 && p[1] <= 1.0; }

struct Border {
  std::vector<Point> points;
  bool is_closed = false;
  std::string end; ///< reason why the curve was lost within the ranges; "" if it was followed to its end
};

class Plane {
public:
  explicit Plane(StudyRun& run)
      : run_(run), settings_(settings_of<MapSettings>(run.study())),
        place_(static_cast<std::size_t>(run.loaded.index_of_number("border"))) {
    for (int i = 0; i < 2; ++i)
      variable_[i] = static_cast<std::size_t>(run.study().index_of_variable(settings_.variables[static_cast<std::size_t>(i)]));
  }

  [[nodiscard]] double value_of(int axis, double share) const {
    const std::vector<double>& range = run_.study().variables[variable_[axis]].range;
    if (share == 0.0 || share == 1.0) return range[share == 1.0];
    return settings_.is_logarithmic ? range[0] * std::pow(range[1] / range[0], share) : range[0] + share * (range[1] - range[0]);
  }

  std::vector<double> at(const std::vector<Point>& places) {
    std::vector<double> points;
    const std::size_t width = run_.law.nominal().size();
    for (const Point& p : places) {
      points.insert(points.end(), run_.law.nominal().begin(), run_.law.nominal().end());
      for (int i = 0; i < 2; ++i) points[points.size() - width + variable_[i]] = value_of(i, p[i]);
    }
    std::vector<double> values;
    for (const StoredSample& sample : run_.evaluator.evaluate(points)) {
      const bool is_ok = sample.outcome.status == SampleStatus::ok;
      values.push_back(is_ok ? sample.outcome.numbers[place_] : std::nan(""));
      bad_ += !is_ok;
    }
    return values;
  }

  /// Returns the point of the curve on the line from p along `direction`, between s = low and s = high.
  std::optional<double> crossing(const Point& p, const Point& direction, double low, double high) {
    const std::vector<double> g = at({along(p, direction, low), along(p, direction, high)});
    if (std::isnan(g[0]) || std::isnan(g[1]) || (g[0] < 0.0) == (g[1] < 0.0)) return {};
    std::vector<Crossing> one{{low, high, g[0], g[1]}};
    close_crossings(one, settings_.tolerance,
                    [&](const std::vector<std::size_t>&, const std::vector<double>& s) { return at({along(p, direction, s[0])}); });
    if (one[0].is_bad) return {};
    has_jump_ = has_jump_ || one[0].is_jump;
    return one[0].root();
  }

  [[nodiscard]] long bad() const { return bad_; }
  [[nodiscard]] bool has_jump() const { return has_jump_; }

private:
  StudyRun& run_;
  const MapSettings& settings_;
  std::size_t place_;
  std::array<std::size_t, 2> variable_{};
  long bad_ = 0;
  bool has_jump_ = false;
};

struct Grid {
  std::size_t n; ///< grid points per side
  std::vector<Point> points;
  std::vector<double> g;

  [[nodiscard]] double width() const { return 1.0 / static_cast<double>(n - 1); }
};

Grid grid_of(Plane& plane, long points) {
  Grid grid{static_cast<std::size_t>(points), {}, {}};
  for (std::size_t i = 0; i < grid.n; ++i)
    for (std::size_t j = 0; j < grid.n; ++j)
      grid.points.push_back({static_cast<double>(i) * grid.width(), static_cast<double>(j) * grid.width()});
  grid.g = plane.at(grid.points);
  return grid;
}

// Finds the crossings of grid lines with the curve.
std::vector<Point> seeds_on_grid(Plane& plane, const Grid& grid_points, double tolerance) {
  const std::size_t n = grid_points.n;
  const std::vector<Point>& grid = grid_points.points;
  const std::vector<double>& g = grid_points.g;
  std::vector<Crossing> crossings;
  std::vector<Point> from, direction;
  const auto look = [&](std::size_t a, std::size_t b) {
    if (std::isnan(g[a]) || std::isnan(g[b]) || (g[a] < 0.0) == (g[b] < 0.0)) return;
    crossings.push_back({0.0, 1.0, g[a], g[b]});
    from.push_back(grid[a]);
    direction.push_back({grid[b][0] - grid[a][0], grid[b][1] - grid[a][1]});
  };
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      if (i + 1 < n) look(i * n + j, (i + 1) * n + j);
      if (j + 1 < n) look(i * n + j, i * n + j + 1);
    }
  close_crossings(crossings, tolerance * static_cast<double>(n - 1),
                  [&](const std::vector<std::size_t>& which, const std::vector<double>& s) {
                    std::vector<Point> places;
                    for (std::size_t k = 0; k < which.size(); ++k) places.push_back(along(from[which[k]], direction[which[k]], s[k]));
                    return plane.at(places);
                  });
  std::vector<Point> seeds;
  for (std::size_t k = 0; k < crossings.size(); ++k)
    if (!crossings[k].is_bad) seeds.push_back(along(from[k], direction[k], crossings[k].root()));
  return seeds;
}

// Returns grid points with a local minimum of the expression's magnitude and no sign change, smallest first. A closed curve that crosses no
// grid line may be near them. Of equal neighbours only the first is returned.
std::vector<std::size_t> hollows_of(const Grid& grid) {
  constexpr std::size_t k_most = 20;
  const auto n = static_cast<long>(grid.n);
  std::vector<std::size_t> hollows;
  for (long i = 0; i < n; ++i)
    for (long j = 0; j < n; ++j) {
      const auto here = static_cast<std::size_t>(i * n + j);
      const double g = grid.g[here];
      bool is_hollow = !std::isnan(g), is_steep = false;
      for (long di = -1; di <= 1; ++di)
        for (long dj = -1; dj <= 1; ++dj) {
          const long k = i + di, l = j + dj;
          if ((di == 0 && dj == 0) || k < 0 || l < 0 || k >= n || l >= n) continue;
          const auto beside = static_cast<std::size_t>(k * n + l);
          const double other = grid.g[beside];
          if (std::isnan(other)) continue;
          is_hollow = is_hollow && (other < 0.0) == (g < 0.0) &&
                      (std::abs(g) < std::abs(other) || (std::abs(g) == std::abs(other) && here < beside));
          is_steep = is_steep || std::abs(g) < std::abs(other);
        }
      if (is_hollow && is_steep) hollows.push_back(here);
    }
  std::stable_sort(hollows.begin(), hollows.end(), [&](std::size_t a, std::size_t b) { return std::abs(grid.g[a]) < std::abs(grid.g[b]); });
  if (hollows.size() > k_most) hollows.resize(k_most);
  return hollows;
}

// Searches a point of the curve from a local minimum of |g|: evaluates eight directions, moves to the best point, and halves the distance
// if none is better.
std::optional<Point> island_at(Plane& plane, Point at, double g, double radius) {
  constexpr int k_rounds = 24, k_ways = 8;
  constexpr double k_least = 1e-3; // smallest distance, relative to the initial one; smaller closed curves are not found
  for (const double least = k_least * radius; radius > least;) {
    for (int round = 0; round < k_rounds; ++round) {
      std::vector<Point> around;
      for (int k = 0; k < k_ways; ++k) {
        const double angle = 2.0 * std::acos(-1.0) * k / k_ways;
        Point q = along(at, {std::cos(angle), std::sin(angle)}, radius);
        for (double& x : q) x = std::clamp(x, 0.0, 1.0);
        around.push_back(q);
      }
      const std::vector<double> values = plane.at(around);
      std::size_t best = around.size();
      for (std::size_t k = 0; k < around.size(); ++k) {
        if (std::isnan(values[k])) continue;
        if ((values[k] < 0.0) != (g < 0.0)) {
          const Point way{around[k][0] - at[0], around[k][1] - at[1]};
          const std::optional<double> s = plane.crossing(at, way, 0.0, 1.0);
          return s ? std::optional<Point>(along(at, way, *s)) : std::nullopt;
        }
        if (std::abs(values[k]) < std::abs(best == around.size() ? g : values[best])) best = k;
      }
      if (best == around.size()) break;
      at = around[best];
      g = values[best];
    }
    radius *= 0.5;
  }
  return {};
}

class Follower {
public:
  Follower(Plane& plane, double step) : plane_(plane), step_(step) {}

  Border follow(const Point& seed) {
    Border border;
    border.points = {seed};
    const std::optional<Point> tangent = tangent_at(seed);
    if (!tangent) {
      border.end = "no direction was found in which it continues";
      return border;
    }
    if (go(border, *tangent)) return border;
    std::reverse(border.points.begin(), border.points.end());
    (void)go(border, {-(*tangent)[0], -(*tangent)[1]});
    return border;
  }

private:
  static constexpr int k_halvings = 6;

  // Finds the direction of the curve at p from a sign change on a small circle around p, evaluated at 16 points. Points outside the ranges
  // are moved to the bounds. Two moved points may then enclose p itself; such a sign change is used only if there is no other.
  std::optional<Point> tangent_at(const Point& p) {
    constexpr int k_circle_points = 16;
    const double radius = 0.1 * step_;
    std::vector<Point> circle;
    std::array<bool, k_circle_points> is_moved_to_bound{};
    for (int k = 0; k < k_circle_points; ++k) {
      const double angle = 2.0 * std::acos(-1.0) * (k + 0.5) / k_circle_points;
      Point q = along(p, {std::cos(angle), std::sin(angle)}, radius);
      is_moved_to_bound[static_cast<std::size_t>(k)] = !is_inside(q);
      for (double& x : q) x = std::clamp(x, 0.0, 1.0);
      circle.push_back(q);
    }
    const std::vector<double> g = plane_.at(circle);
    std::optional<Point> second_best;
    for (std::size_t k = 0; k < circle.size(); ++k) {
      const std::size_t next = (k + 1) % circle.size();
      if (std::isnan(g[k]) || std::isnan(g[next]) || (g[k] < 0.0) == (g[next] < 0.0)) continue;
      const double share = g[k] / (g[k] - g[next]);
      const Point q = along(circle[k], {circle[next][0] - circle[k][0], circle[next][1] - circle[k][1]}, share);
      const double length = distance(p, q);
      if (!(length > 0.0)) continue;
      const Point tangent{(q[0] - p[0]) / length, (q[1] - p[1]) / length};
      if (!is_moved_to_bound[k] && !is_moved_to_bound[next]) return tangent;
      if (!second_best) second_best = tangent;
    }
    return second_best;
  }

  // Makes one step. Returns nothing if the curve is not found within a sector of ±45 degrees.
  std::optional<Point> step(const Point& p, const Point& tangent, double length) {
    const Point normal{-tangent[1], tangent[0]}, ahead = along(p, tangent, length);
    double low = -length, high = length; // limits of the search across the tangent, within the ranges
    for (int i = 0; i < 2; ++i) {
      if (normal[i] == 0.0) continue;
      const double a = -ahead[i] / normal[i], b = (1.0 - ahead[i]) / normal[i];
      low = std::max(low, std::min(a, b));
      high = std::min(high, std::max(a, b));
    }
    if (!(low < high)) return {};
    const std::optional<double> s = plane_.crossing(ahead, normal, low, high);
    if (!s) return {};
    return along(ahead, normal, *s);
  }

  // Returns the point near p at which the curve reaches a bound of the ranges; nothing if it is too far from the bounds.
  std::optional<Point> leave(const Point& p, const Point& tangent) {
    for (int i = 0; i < 2; ++i) {
      const double edge = tangent[i] > 0.0 ? 1.0 : 0.0;
      if (std::abs(p[i] - edge) > 1.5 * step_ || tangent[i] == 0.0) continue;
      if (std::abs(p[i] - edge) < 1e-12) return p;
      Point q = p;
      q[i] = edge;
      Point direction{0.0, 0.0};
      direction[1 - i] = 1.0;
      const double reach = 2.0 * step_, low = std::max(-reach, -q[1 - i]), high = std::min(reach, 1.0 - q[1 - i]);
      if (const std::optional<double> s = plane_.crossing(q, direction, low, high)) return along(q, direction, *s);
    }
    return {};
  }

  // Follows the curve from its last point to the bounds of the ranges. Returns true if the curve closes at its first point.
  bool go(Border& border, Point tangent) {
    constexpr std::size_t k_longest = 20000;
    const Point start = border.points.front();
    const std::size_t before = border.points.size();
    while (border.points.size() < k_longest) {
      const Point p = border.points.back();
      std::optional<Point> next;
      double length = step_;
      for (int k = 0; k <= k_halvings && !next; ++k, length *= 0.5) {
        if (is_inside(along(p, tangent, length))) next = step(p, tangent, length);
      }
      if (!next) {
        const std::optional<Point> end = leave(p, tangent);
        if (end && distance(*end, p) > 1e-12) border.points.push_back(*end);
        if (!end) border.end = "lost: it turns too sharply, or runs without result lie on it";
        return false;
      }
      const double gone = distance(p, *next);
      tangent = {((*next)[0] - p[0]) / gone, ((*next)[1] - p[1]) / gone};
      border.points.push_back(*next);
      if (border.points.size() > before + 2 && distance(*next, start) < step_) {
        border.points.push_back(start);
        border.is_closed = true;
        return true;
      }
    }
    border.end = "longer than " + std::to_string(k_longest) + " steps";
    return false;
  }

  Plane& plane_;
  double step_;
};

bool is_on(const Border& border, const Point& p, double near) {
  for (std::size_t i = 1; i < border.points.size(); ++i) {
    const Point &a = border.points[i - 1], &b = border.points[i];
    const double length = distance(a, b);
    const double share =
        length > 0.0 ? std::clamp(((p[0] - a[0]) * (b[0] - a[0]) + (p[1] - a[1]) * (b[1] - a[1])) / (length * length), 0.0, 1.0) : 0.0;
    if (distance(p, along(a, {b[0] - a[0], b[1] - a[1]}, share)) < near) return true;
  }
  return false;
}

void report(const Border& border, std::size_t number, Plane& plane, StudyRun& run, Answer& answer) {
  const auto& s = settings_of<MapSettings>(run.study());
  for (std::size_t k = 0; k < border.points.size(); ++k)
    for (int i = 0; i < 2; ++i) {
      const double share = border.points[k][i];
      Finding f{"map", "border " + std::to_string(number) + " point " + std::to_string(k + 1), s.variables[static_cast<std::size_t>(i)],
                plane.value_of(i, share)};
      f.low = plane.value_of(i, std::max(0.0, share - s.tolerance));
      f.high = plane.value_of(i, std::min(1.0, share + s.tolerance));
      f.samples = run.evaluator.asked();
      if (k + 1 == border.points.size()) f.status = border.end;
      answer.findings.push_back(f);
    }
  answer.notes.push_back("border " + std::to_string(number) + ": " + std::to_string(border.points.size()) + " points, " +
                         (border.is_closed     ? "closed"
                          : border.end.empty() ? "from end to end of the ranges"
                                               : border.end));
  if (!border.end.empty()) answer.degrade(Standing::not_met);
}

// Notes the largest closed curve that may have been missed: a circle through the corners of a grid square. Near local minima of |g| smaller
// curves are found.
void report_unseen(const Grid& grid, const Plane& plane, const StudyRun& run, Answer& answer) {
  const double radius = grid.width() / std::sqrt(2.0);
  Finding f{"map", "island", "unseen radius, of the ranges", radius};
  f.samples = run.evaluator.asked();
  if (plane.bad() > 0) f.status = "larger next to runs without a result";
  answer.findings.push_back(f);
  char text[240];
  std::snprintf(text, sizeof text,
                "Looks lie %.3g of the ranges apart: an island with a radius of up to %.3g of the ranges may lie between "
                "them unseen; 'points' looks closer.",
                grid.width(), radius);
  answer.notes.emplace_back(text);
}

// Adds the expression as a limit state, so that the evaluator computes it.
void add_border(LoadedStudy& loaded) {
  const auto& s = settings_of<MapSettings>(loaded.study);
  loaded.study.limit_states.push_back({"border", s.expression, s.where, true});
}

void check_map(const LoadedStudy& loaded, std::vector<Diagnostic>& problems) {
  const auto& s = settings_of<MapSettings>(loaded.study);
  std::vector<std::string> names;
  for (const Variable& v : loaded.study.variables) names.push_back(v.name);
  if (s.variables.size() != 2 || s.variables[0] == s.variables[1]) {
    problems.push_back({s.where, "'variables' of [map] names two variables"});
    return;
  }
  for (const std::string& name : s.variables) {
    const int v = loaded.study.index_of_variable(name);
    if (v < 0) {
      problems.push_back({s.where, "there is no variable '" + name + "'" + did_you_mean(name, names)});
      continue;
    }
    const Variable& variable = loaded.study.variables[static_cast<std::size_t>(v)];
    if (variable.range.size() != 2) problems.push_back({variable.where, "variable '" + name + "' needs a 'range' for a map"});
    else if (s.is_logarithmic && !(variable.range[0] > 0.0))
      problems.push_back({variable.where, "a logarithmic map needs ranges above zero"});
  }
}

Answer run_map(StudyRun& run) {
  const auto& s = settings_of<MapSettings>(run.study());
  Plane plane(run);
  const Grid grid = grid_of(plane, s.points);
  std::vector<Point> seeds = seeds_on_grid(plane, grid, s.tolerance);
  for (const std::size_t k : hollows_of(grid))
    if (const auto seed = island_at(plane, grid.points[k], grid.g[k], 0.5 * grid.width())) seeds.push_back(*seed);
  std::vector<Border> borders;
  for (const Point& seed : seeds) {
    const bool is_known = std::any_of(borders.begin(), borders.end(), [&](const Border& b) { return is_on(b, seed, 0.5 * s.step); });
    if (!is_known) borders.push_back(Follower(plane, s.step).follow(seed));
  }
  Answer answer;
  for (std::size_t i = 0; i < borders.size(); ++i) report(borders[i], i + 1, plane, run, answer);
  if (borders.empty()) {
    answer.findings.push_back(
        {"map", "border", "points", 0.0, std::nan(""), std::nan(""), run.evaluator.asked(),
         plane.bad() == run.evaluator.asked() ? "no run gave a value" : "the expression has one sign wherever it was looked at"});
    answer.degrade(Standing::not_met);
  }
  report_unseen(grid, plane, run, answer);
  if (plane.has_jump()) answer.notes.push_back("In places the expression jumps past zero: the border is then where it jumps.");
  if (plane.bad() > 0)
    answer.notes.push_back(std::to_string(plane.bad()) +
                           " runs did not reach their end or are not to be trusted: borders next to them are not found");
  return answer;
}

} // namespace

StudyKind map_kind() {
  StudyKind kind;
  kind.name = "map";
  kind.doc = "the curve in the plane of two variables on which an expression is zero";
  kind.fields = map_fields();
  kind.holds<MapSettings>();
  kind.shown = {"variables", "logarithmic"};
  kind.parts = {{"unseen", "unseen radius"}};
  kind.points = {{"map", "border"}};
  kind.prepare = add_border;
  kind.check = check_map;
  kind.run = run_map;
  return kind;
}

} // namespace steplap::study
