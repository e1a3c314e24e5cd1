#include "transformer/core/core_drawing.h"

#include "mbd/base/number_text.h"
#include "mbd/base/portable_math.h"
#include "mbd/model/entries.h"
#include "transformer/core/core_builder.h"
#include "transformer/core/core_geometry.h"
#include "transformer/core/core_sheet.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace steplap {

namespace {

// Layout of the panels in two rows, pixels.
constexpr double k_gap = 20.0, k_title = 26.0, k_width = 1020.0, k_height = 440.0;
constexpr PanelFrame k_upper_left{k_gap, k_gap + k_title, 520.0, k_height};
constexpr PanelFrame k_upper_right{2.0 * k_gap + 520.0, k_gap + k_title, 440.0, k_height};
constexpr double k_lower = 2.0 * (k_gap + k_title) + k_height;
constexpr PanelFrame k_lower_left{k_gap, k_lower, 480.0, k_height};
constexpr PanelFrame k_lower_right{2.0 * k_gap + 480.0, k_lower, 480.0, k_height};
constexpr long k_most_layers = 22; // number of layers of a book that are drawn

// The style adapts to dark pages (prefers-color-scheme).
const char* const k_style =
    "<style>svg{--paper:#fff;--back:#f6f6f4;--ink:#222;--soft:#666;--rule:#bbb;--limb:#9db8d2;--pale:#d3dfea;"
    "--yoke:#d9c39a;--lap:#c4463a}\n"
    "@media (prefers-color-scheme:dark){svg{--paper:#1d2126;--back:#16191d;--ink:#e4e6e8;--soft:#a3a9b0;--rule:#4a515a;"
    "--limb:#43678a;--pale:#2f4254;--yoke:#77663f;--lap:#f0776a}}\n"
    "text{font:12px sans-serif;fill:var(--ink)} .title{font-size:14px;font-weight:bold} .back{fill:var(--back)} "
    ".panel{fill:var(--paper);stroke:var(--rule)} .limb,.yoke,.other,.hole{stroke:var(--ink);stroke-width:.6} "
    ".limb{fill:var(--limb)} .other{fill:var(--pale)} .yoke{fill:var(--yoke)} .hole{fill:var(--paper)} .lap{fill:var(--lap)} "
    ".axis{stroke:var(--soft);stroke-dasharray:8 3 2 3;stroke-width:.8} .cut{stroke:var(--lap);stroke-width:1} "
    ".name{paint-order:stroke;stroke:var(--limb);stroke-width:5px} .pale{stroke:var(--pale)} "
    ".round{fill:none;stroke:var(--soft);stroke-width:1;stroke-dasharray:5 3} "
    ".dimension,.extension{stroke:var(--soft);stroke-width:.7} .arrow{fill:var(--soft)}</style>\n";

std::string millimetres(double value) { return plain_millimetres(value) + " mm"; }

// Smallest circle around the section, m: position of its centre in depth direction, on the limb's axis, and diameter.
struct Round {
  double centre = 0.0, diameter = 0.0;
};

class Drawing {
public:
  Drawing(const Core& core, const Model& model) : core_(core), model_(model), geometry_(core) {}

  std::string svg() {
    const bool has_stack = !core_.is_counted();
    const double height = k_lower + (has_stack ? k_height + k_gap : -k_title);
    out_ << "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 " << k_width << " " << height << "' width='" << k_width << "' height='"
         << height << "'>\n<title>" << escaped_svg(core_.name) << "</title>\n"
         << k_style << "<rect width='100%' height='100%' class='back'/>\n";
    draw_elevation();
    if (has_stack) {
      draw_section();
      draw_corner(k_lower_left);
      draw_book();
    } else {
      draw_corner(k_upper_right);
    }
    out_ << "</svg>\n";
    return out_.str();
  }

private:
  struct Limb {
    const Core* core;
    std::string name;
    bool is_middle;
    Vec2 middle; ///< middle of the limb in the active part's axes, m
    double side;
  };

  [[nodiscard]] std::vector<Limb> limbs() const;
  void draw_yokes(SheetPanel& panel, const Core& core, const std::vector<Limb>& all) const;
  void draw_limb(SheetPanel& panel, const Limb& limb) const;
  void dimension_elevation(SheetPanel& panel, const std::vector<Limb>& all) const;
  void draw_packets(SheetPanel& panel) const;
  void draw_elevation();
  void draw_section();
  void draw_corner(const PanelFrame& frame);
  void draw_book();
  void draw_laps(SheetPanel& panel, long layers, double edge);

  const Core& core_;
  const Model& model_;
  CoreGeometry geometry_;
  std::ostringstream out_;
};

// Returns the limbs of all [[core]] tables with the same active part: a core with limbs of two widths has two tables.
std::vector<Drawing::Limb> Drawing::limbs() const {
  std::vector<Limb> all;
  const Body& part = *model_.find_body(core_.active_part);
  for (const Core* core : tables_of<Core>(model_)) {
    if (core->active_part != core_.active_part) continue;
    const std::vector<std::string> names = core->all_limbs();
    for (std::size_t i = 0; i < names.size(); ++i) {
      const Body& body = *model_.find_body(names[i]);
      all.push_back({core, names[i], core->is_middle(i), middle_of_limb(*core, body, part), side_of_limb(*core, body, part)});
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const Limb& a, const Limb& b) { return a.middle.x() < b.middle.x(); });
  return all;
}

// Returns the different packets of a stack, widest first.
std::vector<std::size_t> packets_by_width(const Stack& stack) {
  std::vector<std::size_t> order;
  for (std::size_t p = 0; p < stack.packets.size(); ++p)
    if (likeness(stack, p) == p) order.push_back(p);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return stack.packets[a].width > stack.packets[b].width; });
  return order;
}

double width_of(const Core& core) {
  const CoreGeometry geometry(core);
  return geometry.stack().packets[geometry.largest()].width;
}

void Drawing::draw_yokes(SheetPanel& panel, const Core& core, const std::vector<Limb>& all) const {
  const CoreGeometry geometry(core);
  for (const std::size_t p : packets_by_width(geometry.stack())) {
    const Mitre m = geometry.mitre(p, false);
    double low = HUGE_VAL, high = -HUGE_VAL, middle = 0.0;
    for (const Limb& limb : all)
      if (limb.core == &core) {
        low = std::min(low, limb.middle.x() - 0.5 * m.limb_width);
        high = std::max(high, limb.middle.x() + 0.5 * m.limb_width);
        middle = limb.middle.y();
      }
    for (const double level : {1.0, -1.0})
      panel.rectangle(low, high, middle + 0.5 * level * m.core_height, middle + level * (0.5 * m.core_height - m.yoke_height), "yoke");
  }
}

void Drawing::draw_limb(SheetPanel& panel, const Limb& limb) const {
  const CoreGeometry geometry(*limb.core);
  for (const std::size_t p : packets_by_width(geometry.stack())) {
    const Mitre m = geometry.mitre(p, limb.is_middle);
    std::vector<Vec2> ring = limb.is_middle ? whole_pointed_limb(m, 0.0) : whole_limb(m, limb.side, 0.0);
    for (Vec2& point : ring) point += limb.middle;
    panel.polygon(ring, limb.core == &core_ ? "limb" : "other");
  }
}

// Draws yokes behind and limbs in front: every packet, the largest first. Windows are left open.
void Drawing::draw_elevation() {
  const std::vector<Limb> all = limbs();
  const double h = 0.5 * geometry_.mitre(geometry_.largest(), false).core_height;
  Vec2 low(HUGE_VAL, HUGE_VAL), high(-HUGE_VAL, -HUGE_VAL);
  for (const Limb& limb : all) {
    const Vec2 half(0.5 * width_of(*limb.core), 0.5 * limb.core->core_height);
    low = low.cwiseMin(limb.middle - half);
    high = high.cwiseMax(limb.middle + half);
  }
  SheetPanel panel(out_, k_upper_left, "Elevation, dimensions in mm", low, high, {66.0, 92.0, 60.0, 66.0});
  std::vector<const Core*> drawn;
  for (const Limb& limb : all)
    if (std::find(drawn.begin(), drawn.end(), limb.core) == drawn.end()) {
      drawn.push_back(limb.core);
      draw_yokes(panel, *limb.core, all);
    }
  for (const Limb& limb : all) draw_limb(panel, limb);
  for (const Limb& limb : all) {
    panel.line({limb.middle.x(), limb.middle.y() - h}, {limb.middle.x(), limb.middle.y() + h}, "axis");
    const bool is_narrow = panel.length(width_of(*limb.core)) < 6.8 * static_cast<double>(limb.name.size()) + 6.0;
    const Vec2 place = panel.at(limb.middle);
    out_ << "<text transform='translate(" << pixels(place.x() + (is_narrow ? 4.0 : 0.0)) << " "
         << pixels(place.y() + (is_narrow ? 0.0 : 4.0)) << ")" << (is_narrow ? " rotate(-90)" : "") << "' text-anchor='middle' class='"
         << (limb.core == &core_ ? "name" : "name pale") << "'>" << escaped_svg(limb.name) << "</text>\n";
  }
  dimension_elevation(panel, all);
  panel.note("",
             drawn.size() > 1 ? "limbs of '" + core_.name + "' dark blue, all other limbs pale, yokes brown" : "limbs blue, yokes brown");
}

void Drawing::dimension_elevation(SheetPanel& panel, const std::vector<Limb>& all) const {
  const Mitre largest = geometry_.mitre(geometry_.largest(), false);
  const double h = 0.5 * largest.core_height, window = h - largest.yoke_height;
  const auto own = std::find_if(all.begin(), all.end(), [&](const Limb& limb) { return limb.core == &core_; });
  const double middle = own->middle.y();
  const double left = all.front().middle.x() - 0.5 * width_of(*all.front().core);
  const double right = all.back().middle.x() + 0.5 * width_of(*all.back().core);
  panel.dimension_upwards({left, middle - h}, {left, middle + h}, -30.0, plain_millimetres(2.0 * h));
  panel.dimension_upwards({right, middle - h}, {right, middle - window}, 26.0, plain_millimetres(largest.yoke_height));
  panel.dimension_upwards({right, middle - window}, {right, middle + window}, 26.0, plain_millimetres(2.0 * window));
  panel.dimension_upwards({right, middle + window}, {right, middle + h}, 26.0, plain_millimetres(largest.yoke_height));
  for (std::size_t i = 0; i + 1 < all.size(); ++i)
    panel.dimension_across({all[i].middle.x(), middle - h}, {all[i + 1].middle.x(), middle - h}, 22.0,
                           plain_millimetres(all[i + 1].middle.x() - all[i].middle.x()));
  panel.dimension_across({left, middle - h}, {right, middle - h}, 44.0, plain_millimetres(right - left));
  const double half = 0.5 * largest.limb_width;
  panel.dimension_across({own->middle.x() - half, middle + h}, {own->middle.x() + half, middle + h}, -16.0, plain_millimetres(2.0 * half));
}

// Layers of the section as drawn: packets separated by ducts.
struct SectionLayer {
  double width, low, high;
  std::size_t packet;
};

std::vector<SectionLayer> slabs_of(const Stack& stack) {
  std::vector<SectionLayer> slabs;
  std::vector<Duct> ducts = stack.ducts;
  std::sort(ducts.begin(), ducts.end(), [](const Duct& a, const Duct& b) { return a.place < b.place; });
  double drawn = 0.0, steel = 0.0; // depth with ducts, depth without ducts, m
  std::size_t next = 0;
  for (std::size_t i = 0; i < stack.packets.size(); ++i) {
    const Packet& p = stack.packets[i];
    const double end = steel + p.depth;
    while (steel < end) {
      const bool is_cut = next < ducts.size() && ducts[next].place < end;
      const double to = is_cut ? std::max(steel, ducts[next].place) : end;
      if (to - steel > 1e-9) slabs.push_back({p.width, drawn, drawn + to - steel, i});
      drawn += to - steel;
      steel = to;
      if (is_cut) drawn += ducts[next++].width;
    }
  }
  return slabs;
}

// Returns the circle, by ternary search for its centre: the largest distance to a corner is a convex function of the centre.
Round round_about(const std::vector<SectionLayer>& slabs) {
  const auto farthest = [&](double centre) {
    double most = 0.0;
    for (const SectionLayer& s : slabs)
      for (const double y : {s.low, s.high}) most = std::max(most, portable::hypot(0.5 * s.width, y - centre));
    return most;
  };
  double low = slabs.front().low, high = slabs.back().high;
  for (int i = 0; i < 100; ++i) {
    const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
    (farthest(a) < farthest(b) ? high : low) = farthest(a) < farthest(b) ? b : a;
  }
  return {0.5 * (low + high), 2.0 * farthest(0.5 * (low + high))};
}

void Drawing::draw_packets(SheetPanel& panel) const {
  const Stack& stack = geometry_.stack();
  std::vector<double> first(stack.packets.size(), HUGE_VAL), last(stack.packets.size(), -HUGE_VAL);
  for (const SectionLayer& s : slabs_of(stack)) {
    panel.rectangle(-0.5 * s.width, 0.5 * s.width, s.low, s.high, "limb");
    first[s.packet] = std::min(first[s.packet], s.low);
    last[s.packet] = std::max(last[s.packet], s.high);
  }
  std::vector<SheetPanel::Label> labels;
  for (std::size_t i = 0; i < stack.packets.size(); ++i) {
    const Packet& p = stack.packets[i];
    labels.push_back(
        {{0.5 * p.width, 0.5 * (first[i] + last[i])},
         plain_millimetres(p.width) + " × " + plain_millimetres(p.depth) + ", " + std::to_string(sheets_in(stack, p)) + " sheets"});
  }
  panel.labels_at_right(std::move(labels), panel.frame().x + panel.frame().width - 148.0);
}

// Draws the section of a limb in the direction of its axis: packets from the front face (below) to the back, in their smallest enclosing
// circle.
void Drawing::draw_section() {
  const Stack& stack = geometry_.stack();
  const double depth = depth_of(stack);
  const std::vector<SectionLayer> slabs = slabs_of(stack);
  const Round round = round_about(slabs);
  const double half = 0.5 * round.diameter;
  SheetPanel panel(out_, k_upper_right, "Section of a limb, front face below, mm", {-half, round.centre - half},
                   {half, round.centre + half}, {52.0, 172.0, 40.0, 84.0});
  panel.circle({0.0, round.centre}, round.diameter, "round");
  draw_packets(panel);
  panel.line({0.0, round.centre - half}, {0.0, round.centre + half}, "axis");
  panel.line({-half, round.centre}, {half, round.centre}, "axis");
  panel.dimension_across({-half, round.centre}, {half, round.centre}, panel.length(half) + 24.0, "Ø " + plain_millimetres(round.diameter));
  panel.dimension_upwards({-half, 0.0}, {-half, depth}, -22.0, plain_millimetres(depth));
  double area = 0.0;
  for (const Packet& p : stack.packets) area += p.width * p.depth;
  const double circle = M_PI * half * half;
  const auto hundredths = [](double share) { return number_text(std::round(100.0 * share) / 100.0); };
  panel.note(std::to_string(sheets_in(stack)) + " sheets of " + number_text(stack.sheet_thickness * 1e3) + " mm" +
                 (stack.ducts.empty() ? "" : ", " + std::to_string(stack.ducts.size()) + " ducts"),
             "fill factor " + hundredths(area * stack.stacking_factor / circle) + " (steel in the circle; with insulation " +
                 hundredths(area / circle) + ")");
}

// Draws the upper corner of the largest packet, or a T-joint, with the step-lap lines of its book.
void Drawing::draw_corner(const PanelFrame& frame) {
  const bool is_middle = core_.limbs.empty();
  const std::size_t p = geometry_.largest();
  const Mitre m = geometry_.mitre(p, is_middle);
  const double top = 0.5 * m.core_height, low = top - 1.35 * m.yoke_height, half = 0.5 * m.limb_width;
  SheetPanel panel(out_, frame, is_middle ? "Corner: T-joint of the largest packet" : "Corner: mitre of the largest packet",
                   {-1.35 * half, low}, {1.1 * half, top}, {34.0, 70.0, 34.0, 62.0});
  panel.rectangle(-1.35 * half, is_middle ? 1.1 * half : half, top - m.yoke_height, top, "yoke");
  CornerFrame floor; // frame of the line that cuts off the limb at the lower edge
  floor.origin = {0.0, low};
  floor.across = {0.0, 1.0};
  panel.polygon(beyond(is_middle ? pointed_end(m, 1.0, 0.0) : limb_end(m, 1.0, 1.0, 0.0), floor, 0.0), "limb");
  const auto draw_line = [&](double q) {
    // The edge of the yoke's sheet ends at the points where the line crosses both strips.
    for (const double side : {1.0, -1.0}) {
      if (!is_middle && side < 0.0) continue;
      const CornerFrame f = is_middle ? notch_frame(m, side, 1.0) : corner_frame(m, 1.0, 1.0);
      std::vector<Vec2> strip = {{-half, top - m.yoke_height}, {half, top - m.yoke_height}, {half, top}, {-half, top}};
      if (is_middle) strip = {{-side * half, top - m.yoke_height}, {0.0, top - m.yoke_height}, {0.0, top}, {-side * half, top}};
      if (is_middle && side < 0.0) std::reverse(strip.begin(), strip.end());
      std::vector<Vec2> ends;
      for (std::size_t i = 0; i < strip.size(); ++i) {
        const Vec2 &a = strip[i], &b = strip[(i + 1) % strip.size()];
        const double d = f.across.dot(a - f.origin) - q, e = f.across.dot(b - f.origin) - q;
        if ((d < 0.0) != (e < 0.0)) ends.emplace_back(a + (b - a) * (d / (d - e)));
      }
      if (ends.size() != 2) continue;
      panel.line(ends[0], ends[1], "cut");
    }
  };
  const CornerFrame mitre = is_middle ? notch_frame(m, 1.0, 1.0) : corner_frame(m, 1.0, 1.0);
  const std::string mitre_text = "limb " + millimetres(m.limb_width) + ", yoke " + millimetres(m.yoke_height) + ", mitre " +
                                 millimetres(mitre.length) + " at " +
                                 number_text(std::round(geometry_.angle(p, is_middle) * 572.957795) / 10.0) + "°";
  if (core_.is_counted()) {
    draw_line(-0.5 * *core_.overlap);
    draw_line(0.5 * *core_.overlap);
    panel.note("overlap " + millimetres(*core_.overlap) + " between the lines", mitre_text);
  } else {
    for (long k = 0; k < geometry_.stack().book.steps; ++k) draw_line(geometry_.line({p, k}, is_middle));
    panel.note(std::to_string(geometry_.stack().book.steps) + " lines, " + millimetres(geometry_.pitch(p, is_middle)) +
                   " apart across the mitre (red)",
               mitre_text);
  }
  panel.dimension_upwards({1.1 * half, top - m.yoke_height}, {1.1 * half, top}, 20.0, plain_millimetres(m.yoke_height));
  panel.dimension_across({-half, low}, {half, low}, 22.0, plain_millimetres(m.limb_width));
  const Mitre outer = geometry_.mitre(geometry_.largest(), false);
  const Vec2 cross_of_axes(0.0, 0.5 * (outer.core_height - outer.yoke_height));
  for (const Vec2& hole : core_.bolt_holes) panel.circle(cross_of_axes + hole, *core_.bolt_hole_diameter, "hole");
  panel.line({0.0, low}, {0.0, top}, "axis");
  panel.line({-1.35 * half, cross_of_axes.y()}, {1.1 * half, cross_of_axes.y()}, "axis");
}

// Draws the section across the mitre: layers above each other, sheets of the yoke on the left, of the limb on the right, overlaps between.
void Drawing::draw_book() {
  const Stack& stack = geometry_.stack();
  const bool is_middle = core_.limbs.empty();
  const std::size_t p = geometry_.largest();
  const long layers = std::min({layers_in(stack, stack.packets[p]), 2 * period_of(stack.book) + 1, k_most_layers});
  const double s = geometry_.pitch(p, is_middle), n = static_cast<double>(stack.book.steps);
  const double edge = 0.5 * (n - 1.0) * s + 1.6 * s;
  SheetPanel panel(out_, k_lower_right, "Book across the mitre, thickness enlarged", {-edge, -0.9},
                   {edge, static_cast<double>(layers) + 0.3}, {34.0, 34.0, 34.0, 34.0}, false);
  for (long i = 0; i < layers; ++i) {
    const double q = geometry_.line({p, position_of(stack.book, i)}, is_middle), g = 0.5 * stack.book.clearance,
                 low = static_cast<double>(i);
    panel.rectangle(-edge, q - g, low + 0.14, low + 0.86, "yoke");
    panel.rectangle(q + g, edge, low + 0.14, low + 0.86, "limb");
    panel.text({-edge, low + 0.5}, std::to_string(position_of(stack.book, i) + 1), "end");
  }
  draw_laps(panel, layers, edge);
  panel.line({0.0, 0.0}, {0.0, static_cast<double>(layers)}, "axis");
  panel.text({-0.7 * edge, -0.35}, "yoke");
  panel.text({0.7 * edge, -0.35}, "limb");
  Book book = stack.book;
  book.pitch = s;
  panel.note("overlaps red: " + millimetres(mean_overlap(book)) + " in the mean; middle of the mitre dashed",
             (book.kind == BookKind::saw_tooth ? "saw tooth"
              : book.kind == BookKind::zig_zag ? "zig-zag"
                                               : "zig-zag, ends doubled") +
                 std::string(", a layer is ") + std::to_string(book.sheets_per_layer) + (book.sheets_per_layer > 1 ? " sheets" : " sheet") +
                 ", clearance " + millimetres(book.clearance));
}

void Drawing::draw_laps(SheetPanel& panel, long layers, double edge) {
  const Stack& stack = geometry_.stack();
  const std::size_t p = geometry_.largest();
  const bool is_middle = core_.limbs.empty();
  for (long i = 0; i + 1 < layers; ++i) {
    const double here = geometry_.line({p, position_of(stack.book, i)}, is_middle),
                 there = geometry_.line({p, position_of(stack.book, i + 1)}, is_middle);
    const double low = std::min(here, there) + 0.5 * stack.book.clearance, high = std::max(here, there) - 0.5 * stack.book.clearance;
    if (high > low && high < edge) panel.rectangle(low, high, static_cast<double>(i) + 0.9, static_cast<double>(i) + 1.1, "lap");
  }
}

} // namespace

std::string core_svg(const Core& core, const Model& model) { return Drawing(core, model).svg(); }

} // namespace steplap
