#include "run/core_drawing.h"

#include "mbd/base/number_text.h"
#include "transformer/core_builder.h"
#include "transformer/core_geometry.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace steplap {

namespace {

// Four panels of one size, in pixels.
constexpr double k_panel = 420.0, k_gap = 20.0, k_title = 26.0, k_edge = 34.0;
const char* const k_limb = "#9db8d2";
const char* const k_yoke = "#d9c39a";
const char* const k_lap = "#c4463a";
constexpr long k_most_layers = 22; // drawn of a book

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<') out += "&lt;";
    else if (c == '&') out += "&amp;";
    else out += c;
  }
  return out;
}

std::string px(double value) { return number_text(std::round(value * 100.0) / 100.0); }
std::string millimetres(double value) { return number_text(std::round(value * 1e4) / 10.0) + " mm"; }

// A frame of the image with a scale of its own; y upwards.
class Panel {
public:
  Panel(std::ostream& out, int column, int row, const std::string& title, const Vec2& low,
        const Vec2& high, bool is_to_scale = true)
      : out_(out), low_(low) {
    x_ = k_gap + column * (k_panel + k_gap);
    y_ = k_gap + row * (k_panel + k_title + k_gap) + k_title;
    const Vec2 size = (high - low).cwiseMax(1e-9);
    const double room = k_panel - 2.0 * k_edge;
    scale_ = Vec2(room / size.x(), room / size.y());
    if (is_to_scale) scale_ = Vec2::Constant(std::min(scale_.x(), scale_.y()));
    offset_ = 0.5 * (Vec2(k_panel, k_panel) - size.cwiseProduct(scale_));
    out_ << "<text x='" << px(x_) << "' y='" << px(y_ - 9.0) << "' class='title'>" << escaped(title)
         << "</text>\n"
         << "<rect x='" << px(x_) << "' y='" << px(y_) << "' width='" << k_panel << "' height='"
         << k_panel << "' class='panel'/>\n";
  }

  [[nodiscard]] Vec2 at(const Vec2& p) const {
    const Vec2 q = (p - low_).cwiseProduct(scale_) + offset_;
    return {x_ + q.x(), y_ + k_panel - q.y()};
  }
  [[nodiscard]] double length(double metres) const { return metres * scale_.x(); }

  void polygon(const std::vector<Vec2>& ring, const std::string& style) {
    out_ << "<polygon points='";
    for (const Vec2& p : ring) out_ << px(at(p).x()) << "," << px(at(p).y()) << " ";
    out_ << "' " << style << "/>\n";
  }
  void rectangle(double x0, double x1, double y0, double y1, const std::string& style) {
    polygon({{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, style);
  }
  void line(const Vec2& a, const Vec2& b, const std::string& style) {
    out_ << "<line x1='" << px(at(a).x()) << "' y1='" << px(at(a).y()) << "' x2='" << px(at(b).x())
         << "' y2='" << px(at(b).y()) << "' " << style << "/>\n";
  }
  void circle(const Vec2& centre, double diameter, const std::string& style) {
    out_ << "<circle cx='" << px(at(centre).x()) << "' cy='" << px(at(centre).y()) << "' r='"
         << px(0.5 * length(diameter)) << "' " << style << "/>\n";
  }
  void text(const Vec2& place, const std::string& words, const std::string& anchor = "middle", double down = 4.0) {
    out_ << "<text x='" << px(at(place).x()) << "' y='" << px(at(place).y() + down)
         << "' text-anchor='" << anchor << "'>" << escaped(words) << "</text>\n";
  }
  /// Along the lower edge of the frame, under what is drawn; another one along the upper edge.
  void note(const std::string& below, const std::string& above = "") {
    out_ << "<text x='" << px(x_ + 8.0) << "' y='" << px(y_ + k_panel - 9.0) << "'>" << escaped(below) << "</text>\n";
    if (!above.empty())
      out_ << "<text x='" << px(x_ + 8.0) << "' y='" << px(y_ + 18.0) << "'>" << escaped(above)
           << "</text>\n";
  }

private:
  std::ostream& out_;
  Vec2 low_, scale_, offset_;
  double x_ = 0.0, y_ = 0.0;
};

std::string fill(const char* colour, const char* more = "") {
  return std::string("fill='") + colour + "' class='sheet' " + more;
}

class Drawing {
public:
  Drawing(const Core& core, const Model& model) : core_(core), model_(model), geometry_(core) {}

  std::string svg() {
    const bool has_stack = !core_.is_counted();
    const double width = 2.0 * k_panel + 3.0 * k_gap, height = 2.0 * (k_panel + k_title) + 3.0 * k_gap;
    out_ << "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 " << width << " " << height
         << "' width='" << width << "' height='" << height << "'>\n<title>" << escaped(core_.name)
         << "</title>\n<style>text{font:12px sans-serif;fill:#222} "
            ".title{font-size:14px;font-weight:bold} "
         << ".panel{fill:#fff;stroke:#bbb} .sheet{stroke:#444;stroke-width:.6} "
            ".axis{stroke:#888;stroke-dasharray:8 3 2 3;stroke-width:.8} "
         << ".cut{stroke:#c4463a;stroke-width:1}</style>\n<rect width='100%' height='100%' "
            "fill='#f6f6f4'/>\n";
    draw_elevation();
    draw_corner();
    if (has_stack) {
      draw_section();
      draw_book();
    }
    out_ << "</svg>\n";
    return out_.str();
  }

private:
  struct Limb {
    std::size_t index;
    double x, side;
  };

  [[nodiscard]] std::vector<Limb> limbs() const {
    std::vector<Limb> all;
    const Body& part = *model_.find_body(core_.active_part);
    const std::vector<std::string> names = core_.all_limbs();
    for (std::size_t i = 0; i < names.size(); ++i) {
      const Body& body = *model_.find_body(names[i]);
      all.push_back({i, middle_of_limb(core_, body, part).x(), side_of_limb(core_, body, part)});
    }
    return all;
  }

  void draw_elevation();
  void draw_section();
  void draw_corner();
  void draw_book();
  void draw_laps(Panel& panel, long layers, double edge);

  const Core& core_;
  const Model& model_;
  CoreGeometry geometry_;
  std::ostringstream out_;
};

// Yokes behind, limbs on them: every packet, the largest first.
void Drawing::draw_elevation() {
  const std::vector<Limb> all = limbs();
  const auto [rear, front] = std::minmax_element(
      all.begin(), all.end(), [](const Limb& a, const Limb& b) { return a.x < b.x; });
  const Stack& stack = geometry_.stack();
  const double h = 0.5 * core_.core_height, w = 0.5 * stack.packets[geometry_.largest()].width;
  Panel panel(out_, 0, 0, "Elevation", {rear->x - w, -h}, {front->x + w, h});
  std::vector<std::size_t> order;
  for (std::size_t p = 0; p < stack.packets.size(); ++p)
    if (likeness(stack, p) == p) order.push_back(p);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return stack.packets[a].width > stack.packets[b].width;
  });
  for (const std::size_t p : order) {
    const Mitre m = geometry_.mitre(p, false);
    const double half = 0.5 * m.limb_width;
    for (const double level : {1.0, -1.0})
      panel.rectangle(rear->x - half, front->x + half, 0.5 * level * m.core_height,
                      level * (0.5 * m.core_height - m.yoke_height), fill(k_yoke));
  }
  for (const std::size_t p : order)
    for (const Limb& limb : all) {
      const bool is_middle = core_.is_middle(limb.index);
      const Mitre m = geometry_.mitre(p, is_middle);
      std::vector<Vec2> ring = is_middle ? whole_pointed_limb(m, 0.0) : whole_limb(m, limb.side, 0.0);
      for (Vec2& point : ring) point.x() += limb.x;
      panel.polygon(ring, fill(k_limb));
    }
  for (const Limb& limb : all) {
    panel.line({limb.x, -h}, {limb.x, h}, "class='axis'");
    panel.text({limb.x, 0.0}, core_.all_limbs()[limb.index]);
  }
  const Mitre largest = geometry_.mitre(geometry_.largest(), false);
  panel.note("core " + millimetres(largest.core_height) + " high, yoke " +
                 millimetres(largest.yoke_height) + ", window " +
                 millimetres(largest.core_height - 2.0 * largest.yoke_height),
             "limbs blue, yokes brown" +
                 std::string(all.size() > 1
                                 ? "; outer axes " + millimetres(front->x - rear->x) + " apart"
                                 : ""));
}

// Of a limb, seen along it: packets from the front face (below) to the back.
void Drawing::draw_section() {
  const Stack& stack = geometry_.stack();
  double widest = 0.0;
  for (const Packet& p : stack.packets) widest = std::max(widest, p.width);
  const double depth = depth_of(stack);
  Panel panel(out_, 0, 1, "Section of a limb, front face below", {-0.5 * widest, 0.0}, {0.5 * widest, depth});
  std::vector<Duct> ducts = stack.ducts;
  std::sort(ducts.begin(), ducts.end(), [](const Duct& a, const Duct& b) { return a.place < b.place; });
  double drawn = 0.0, steel = 0.0; // depth with and without the ducts
  std::size_t next = 0;
  for (const Packet& p : stack.packets) {
    const double end = steel + p.depth, start = drawn;
    while (steel < end) {
      const bool is_cut = next < ducts.size() && ducts[next].place < end;
      const double to = is_cut ? std::max(steel, ducts[next].place) : end;
      if (to - steel > 1e-9) panel.rectangle(-0.5 * p.width, 0.5 * p.width, drawn, drawn + to - steel, fill(k_limb));
      drawn += to - steel;
      steel = to;
      if (is_cut) drawn += ducts[next++].width;
    }
    if (panel.length(p.depth) > 11.0)
      panel.text({0.0, 0.5 * (start + drawn)}, millimetres(p.width) + " × " + millimetres(p.depth) +
                                                   ", " + std::to_string(sheets_in(stack, p)) +
                                                   " sheets");
  }
  panel.line({0.0, 0.0}, {0.0, depth}, "class='axis'");
  panel.note("depth " + millimetres(depth) + ", " + std::to_string(sheets_in(stack)) +
             " sheets of " + number_text(stack.sheet_thickness * 1e3) + " mm" +
             (stack.ducts.empty() ? "" : ", " + std::to_string(stack.ducts.size()) + " ducts"));
}

// The largest packet's top corner in front of the active part, or a T-joint, with the lines of its book.
void Drawing::draw_corner() {
  const bool is_middle = core_.limbs.empty();
  const std::size_t p = geometry_.largest();
  const Mitre m = geometry_.mitre(p, is_middle);
  const double top = 0.5 * m.core_height, low = top - 1.35 * m.yoke_height, half = 0.5 * m.limb_width;
  Panel panel(out_, 1, 0,
              is_middle ? "Corner: T-joint of the largest packet"
                        : "Corner: mitre of the largest packet",
              {-1.35 * half, low}, {1.1 * half, top});
  panel.rectangle(-1.35 * half, is_middle ? 1.1 * half : half, top - m.yoke_height, top, fill(k_yoke));
  CornerFrame floor; // cuts the limb off at the lower edge
  floor.origin = {0.0, low};
  floor.across = {0.0, 1.0};
  panel.polygon(beyond(is_middle ? pointed_end(m, 1.0, 0.0) : limb_end(m, 1.0, 1.0, 0.0), floor, 0.0), fill(k_limb));
  const auto draw_line = [&](double q) {
    // Where the line crosses both strips: the edge of the yoke's sheet.
    for (const double side : {1.0, -1.0}) {
      if (!is_middle && side < 0.0) continue;
      const CornerFrame f = is_middle ? notch_frame(m, side, 1.0) : corner_frame(m, 1.0, 1.0);
      std::vector<Vec2> strip = {{-half, top - m.yoke_height}, {half, top - m.yoke_height}, {half, top}, {-half, top}};
      if (is_middle)
        strip = {{-side * half, top - m.yoke_height},
                 {0.0, top - m.yoke_height},
                 {0.0, top},
                 {-side * half, top}};
      if (is_middle && side < 0.0) std::reverse(strip.begin(), strip.end());
      std::vector<Vec2> ends;
      for (std::size_t i = 0; i < strip.size(); ++i) {
        const Vec2 &a = strip[i], &b = strip[(i + 1) % strip.size()];
        const double d = f.across.dot(a - f.origin) - q, e = f.across.dot(b - f.origin) - q;
        if ((d < 0.0) != (e < 0.0)) ends.emplace_back(a + (b - a) * (d / (d - e)));
      }
      if (ends.size() != 2) continue;
      panel.line(ends[0], ends[1], "class='cut'");
    }
  };
  const CornerFrame mitre = is_middle ? notch_frame(m, 1.0, 1.0) : corner_frame(m, 1.0, 1.0);
  const std::string mitre_text =
      "limb " + millimetres(m.limb_width) + ", yoke " + millimetres(m.yoke_height) + ", mitre " +
      millimetres(mitre.length) + " at " +
      number_text(std::round(geometry_.angle(p, is_middle) * 572.957795) / 10.0) + "°";
  if (core_.is_counted()) {
    draw_line(-0.5 * *core_.overlap);
    draw_line(0.5 * *core_.overlap);
    panel.note("overlap " + millimetres(*core_.overlap) + " between the lines", mitre_text);
  } else {
    for (long k = 0; k < geometry_.stack().book.steps; ++k) draw_line(geometry_.line({p, k}, is_middle));
    panel.note(std::to_string(geometry_.stack().book.steps) + " lines, " +
                   millimetres(geometry_.pitch(p, is_middle)) + " apart across the mitre (red)",
               mitre_text);
  }
  const Mitre outer = geometry_.mitre(geometry_.largest(), false);
  const Vec2 cross_of_axes(0.0, 0.5 * (outer.core_height - outer.yoke_height));
  for (const Vec2& hole : core_.bolt_holes)
    panel.circle(cross_of_axes + hole, *core_.bolt_hole_diameter, "fill='#fff' class='sheet'");
  panel.line({0.0, low}, {0.0, top}, "class='axis'");
  panel.line({-1.35 * half, cross_of_axes.y()}, {1.1 * half, cross_of_axes.y()}, "class='axis'");
}

// Across the mitre: one layer above the other, the yoke's sheets left, the limb's right, overlaps between them.
void Drawing::draw_book() {
  const Stack& stack = geometry_.stack();
  const bool is_middle = core_.limbs.empty();
  const std::size_t p = geometry_.largest();
  const long layers = std::min({layers_in(stack, stack.packets[p]), 2 * period_of(stack.book) + 1, k_most_layers});
  const double s = geometry_.pitch(p, is_middle), n = static_cast<double>(stack.book.steps);
  const double edge = 0.5 * (n - 1.0) * s + 1.6 * s;
  Panel panel(out_, 1, 1, "Book across the mitre, thickness enlarged", {-edge, -0.9},
              {edge, static_cast<double>(layers) + 0.3}, false);
  for (long i = 0; i < layers; ++i) {
    const double q = geometry_.line({p, position_of(stack.book, i)}, is_middle),
                 g = 0.5 * stack.book.clearance, low = static_cast<double>(i);
    panel.rectangle(-edge, q - g, low + 0.14, low + 0.86, fill(k_yoke));
    panel.rectangle(q + g, edge, low + 0.14, low + 0.86, fill(k_limb));
    panel.text({-edge, low + 0.5}, std::to_string(position_of(stack.book, i) + 1), "end");
  }
  draw_laps(panel, layers, edge);
  panel.line({0.0, 0.0}, {0.0, static_cast<double>(layers)}, "class='axis'");
  panel.text({-0.7 * edge, -0.35}, "yoke");
  panel.text({0.7 * edge, -0.35}, "limb");
  Book book = stack.book;
  book.pitch = s;
  panel.note("overlaps red: " + millimetres(mean_overlap(book)) +
                 " in the mean; middle of the mitre dashed",
             (book.kind == BookKind::saw_tooth ? "saw tooth"
              : book.kind == BookKind::zig_zag ? "zig-zag"
                                               : "zig-zag, ends doubled") +
                 std::string(", a layer is ") + std::to_string(book.sheets_per_layer) +
                 (book.sheets_per_layer > 1 ? " sheets" : " sheet") + ", clearance " +
                 millimetres(book.clearance));
}

void Drawing::draw_laps(Panel& panel, long layers, double edge) {
  const Stack& stack = geometry_.stack();
  const std::size_t p = geometry_.largest();
  const bool is_middle = core_.limbs.empty();
  for (long i = 0; i + 1 < layers; ++i) {
    const double here = geometry_.line({p, position_of(stack.book, i)}, is_middle),
                 there = geometry_.line({p, position_of(stack.book, i + 1)}, is_middle);
    const double low = std::min(here, there) + 0.5 * stack.book.clearance,
                 high = std::max(here, there) - 0.5 * stack.book.clearance;
    if (high > low && high < edge)
      panel.rectangle(low, high, static_cast<double>(i) + 0.9, static_cast<double>(i) + 1.1,
                      std::string("fill='") + k_lap + "'");
  }
}

} // namespace

std::string core_svg(const Core& core, const Model& model) { return Drawing(core, model).svg(); }

} // namespace steplap
