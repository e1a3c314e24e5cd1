#include "transformer/core/core_sheet.h"

#include "mbd/base/number_text.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

constexpr double k_arrow = 7.0;  // arrow length of dimension lines, pixels
constexpr double k_letter = 6.8; // mean width of a character at a font size of 12 pixels
constexpr double k_row = 14.0;   // distance between lines of labels, pixels

double width_of(const std::string& words) {
  // Only the first byte of a UTF-8 character has a width.
  return k_letter * static_cast<double>(std::count_if(words.begin(), words.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

} // namespace

std::string escaped_svg(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<') out += "&lt;";
    else if (c == '&') out += "&amp;";
    else out += c;
  }
  return out;
}

std::string pixels(double value) { return number_text(std::round(value * 100.0) / 100.0); }
std::string plain_millimetres(double metres) { return number_text(std::round(metres * 1e4) / 10.0); }

SheetPanel::SheetPanel(std::ostream& out, const PanelFrame& frame, const std::string& title, const Vec2& low, const Vec2& high,
                       const PanelEdges& edges, bool is_to_scale)
    : out_(out), frame_(frame), low_(low) {
  const Vec2 size = (high - low).cwiseMax(1e-9);
  const Vec2 room(frame.width - edges.left - edges.right, frame.height - edges.top - edges.bottom);
  scale_ = Vec2(room.x() / size.x(), room.y() / size.y());
  if (is_to_scale) scale_ = Vec2::Constant(std::min(scale_.x(), scale_.y()));
  offset_ = Vec2(edges.left, edges.bottom) + 0.5 * (room - size.cwiseProduct(scale_));
  out_ << "<text x='" << pixels(frame.x) << "' y='" << pixels(frame.y - 9.0) << "' class='title'>" << escaped_svg(title)
       << "</text>\n<rect x='" << pixels(frame.x) << "' y='" << pixels(frame.y) << "' width='" << pixels(frame.width) << "' height='"
       << pixels(frame.height) << "' class='panel'/>\n";
}

Vec2 SheetPanel::at(const Vec2& p) const {
  const Vec2 q = (p - low_).cwiseProduct(scale_) + offset_;
  return {frame_.x + q.x(), frame_.y + frame_.height - q.y()};
}

void SheetPanel::polygon(const std::vector<Vec2>& ring, const std::string& kind) {
  out_ << "<polygon points='";
  for (const Vec2& p : ring) out_ << pixels(at(p).x()) << "," << pixels(at(p).y()) << " ";
  out_ << "' class='" << kind << "'/>\n";
}

void SheetPanel::rectangle(double x0, double x1, double y0, double y1, const std::string& kind) {
  polygon({{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, kind);
}

void SheetPanel::line_between(const Vec2& a, const Vec2& b, const std::string& kind) {
  out_ << "<line x1='" << pixels(a.x()) << "' y1='" << pixels(a.y()) << "' x2='" << pixels(b.x()) << "' y2='" << pixels(b.y())
       << "' class='" << kind << "'/>\n";
}

void SheetPanel::line(const Vec2& a, const Vec2& b, const std::string& kind) { line_between(at(a), at(b), kind); }

void SheetPanel::circle(const Vec2& centre, double diameter, const std::string& kind) {
  out_ << "<circle cx='" << pixels(at(centre).x()) << "' cy='" << pixels(at(centre).y()) << "' r='" << pixels(0.5 * length(diameter))
       << "' class='" << kind << "'/>\n";
}

void SheetPanel::text(const Vec2& place, const std::string& words, const std::string& anchor, double down) {
  out_ << "<text x='" << pixels(at(place).x()) << "' y='" << pixels(at(place).y() + down) << "' text-anchor='" << anchor << "'>"
       << escaped_svg(words) << "</text>\n";
}

void SheetPanel::note(const std::string& below, const std::string& above) {
  out_ << "<text x='" << pixels(frame_.x + 8.0) << "' y='" << pixels(frame_.y + frame_.height - 9.0) << "'>" << escaped_svg(below)
       << "</text>\n";
  if (!above.empty())
    out_ << "<text x='" << pixels(frame_.x + 8.0) << "' y='" << pixels(frame_.y + 18.0) << "'>" << escaped_svg(above) << "</text>\n";
}

void SheetPanel::arrow(const Vec2& tip, const Vec2& direction) {
  const Vec2 back = tip - k_arrow * direction, side = 0.32 * k_arrow * Vec2(-direction.y(), direction.x());
  out_ << "<polygon points='";
  for (const Vec2& p : {tip, Vec2(back + side), Vec2(back - side)}) out_ << pixels(p.x()) << "," << pixels(p.y()) << " ";
  out_ << "' class='arrow'/>\n";
}

void SheetPanel::dimension_across(const Vec2& a, const Vec2& b, double off, const std::string& words) {
  Vec2 p = at(a), q = at(b);
  if (p.x() > q.x()) std::swap(p, q);
  const double y = off > 0.0 ? std::max(p.y(), q.y()) + off : std::min(p.y(), q.y()) + off, beyond = off > 0.0 ? 4.0 : -4.0;
  for (const Vec2& end : {p, q}) line_between({end.x(), end.y() + 0.5 * beyond}, {end.x(), y + beyond}, "extension");
  // Short dimension lines have their arrows outside, and the figure next to the arrow.
  const bool is_short = q.x() - p.x() < width_of(words) + 2.0 * k_arrow;
  const double out = is_short ? 2.0 * k_arrow : 0.0;
  line_between({p.x() - out, y}, {q.x() + out, y}, "dimension");
  arrow({p.x(), y}, {is_short ? 1.0 : -1.0, 0.0});
  arrow({q.x(), y}, {is_short ? -1.0 : 1.0, 0.0});
  const double x = is_short ? q.x() + out + 3.0 : 0.5 * (p.x() + q.x());
  out_ << "<text x='" << pixels(x) << "' y='" << pixels(y + (is_short ? 4.0 : -4.0)) << "' text-anchor='" << (is_short ? "start" : "middle")
       << "'>" << escaped_svg(words) << "</text>\n";
}

void SheetPanel::dimension_upwards(const Vec2& a, const Vec2& b, double off, const std::string& words) {
  Vec2 p = at(a), q = at(b);
  if (p.y() < q.y()) std::swap(p, q);
  const double x = off > 0.0 ? std::max(p.x(), q.x()) + off : std::min(p.x(), q.x()) + off, beyond = off > 0.0 ? 4.0 : -4.0;
  for (const Vec2& end : {p, q}) line_between({end.x() + 0.5 * beyond, end.y()}, {x + beyond, end.y()}, "extension");
  const bool is_short = p.y() - q.y() < 2.0 * k_arrow + 4.0;
  const double out = is_short ? 2.0 * k_arrow : 0.0;
  line_between({x, p.y() + out}, {x, q.y() - out}, "dimension");
  arrow({x, p.y()}, {0.0, is_short ? -1.0 : 1.0});
  arrow({x, q.y()}, {0.0, is_short ? 1.0 : -1.0});
  // The text is along the line if this is long enough, otherwise next to it.
  const double y = 0.5 * (p.y() + q.y());
  if (p.y() - q.y() < width_of(words) + 2.0 * k_arrow)
    out_ << "<text x='" << pixels(x + (off > 0.0 ? 6.0 : -6.0)) << "' y='" << pixels(y + 4.0) << "' text-anchor='"
         << (off > 0.0 ? "start" : "end") << "'>" << escaped_svg(words) << "</text>\n";
  else
    out_ << "<text transform='translate(" << pixels(x - 4.0) << " " << pixels(y) << ") rotate(-90)' text-anchor='middle'>"
         << escaped_svg(words) << "</text>\n";
}

void SheetPanel::labels_at_right(std::vector<Label> labels, double x) {
  if (labels.empty()) return;
  std::stable_sort(labels.begin(), labels.end(), [](const Label& a, const Label& b) { return a.place.y() > b.place.y(); });
  const double top = frame_.y + 34.0, bottom = frame_.y + frame_.height - 44.0;
  const auto room = std::max<std::size_t>(1, static_cast<std::size_t>((bottom - top) / k_row) + 1);
  if (labels.size() > room) {
    std::vector<Label> fewer;
    for (std::size_t i = 0; i < room; ++i) fewer.push_back(labels[i * (labels.size() - 1) / std::max<std::size_t>(1, room - 1)]);
    labels = std::move(fewer);
  }
  // First pass from above: each label as near to its point as the previous label permits. Second pass from the lower edge upwards.
  std::vector<double> rows;
  for (const Label& label : labels) rows.push_back(std::max(at(label.place).y(), rows.empty() ? top : rows.back() + k_row));
  for (std::size_t i = rows.size(); i-- > 0;) rows[i] = std::min(rows[i], i + 1 < rows.size() ? rows[i + 1] - k_row : bottom);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    line_between(at(labels[i].place), {x - 12.0, rows[i]}, "extension");
    line_between({x - 12.0, rows[i]}, {x - 3.0, rows[i]}, "extension");
    out_ << "<text x='" << pixels(x) << "' y='" << pixels(rows[i] + 4.0) << "'>" << escaped_svg(labels[i].words) << "</text>\n";
  }
}

} // namespace steplap
