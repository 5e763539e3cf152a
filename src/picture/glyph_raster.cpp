#include "picture/glyph_raster.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <string_view>

namespace mssim {
namespace {

struct GlyphPoint {
  double x = 0, y = 0;
};

/// A word of `Glyph::strokes`.
struct GlyphWord {
  char letter = 0;
  GlyphPoint control, to;
};

double next_number(std::string_view& text) {
  text.remove_prefix(std::min(text.size(), text.find_first_not_of(' ')));
  double number = 0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), number).ptr;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

/// The axis that `strokes` begins with, which it then no longer does; else the left stem.
double taken_axis(std::string_view& strokes) {
  if (!strokes.starts_with('S')) return 0;
  strokes.remove_prefix(1);
  return next_number(strokes);
}

std::vector<GlyphWord> words_of(std::string_view strokes) {
  std::vector<GlyphWord> words;
  while (!strokes.empty()) {
    GlyphWord word;
    word.letter = strokes.front();
    strokes.remove_prefix(1);
    if (word.letter == ' ') continue;
    if (word.letter == 'Q') word.control = {next_number(strokes), next_number(strokes)};
    word.to = {next_number(strokes), next_number(strokes)};
    words.push_back(word);
  }
  return words;
}

/// Which way a line runs at one of its ends, as far as it matters for fitting it to pixels.
enum class Course { horizontal, vertical, other };

Course course_between(const GlyphPoint& a, const GlyphPoint& b) {
  if (a.x == b.x) return Course::vertical;
  return a.y == b.y ? Course::horizontal : Course::other;
}

bool continues_stroke(char letter) { return letter != 'M' && letter != 'D'; }

/// What meets at the end of `words[i]`.
struct Meeting {
  bool vertical = false, horizontal = false, straight = false;

  Meeting(const std::vector<GlyphWord>& words, std::size_t i) {
    const GlyphPoint& point = words[i].to;
    if (continues_stroke(words[i].letter)) {
      const char letter = words[i].letter;
      add(letter, letter == 'H'   ? Course::vertical
                  : letter == 'V' ? Course::horizontal
                  : letter == 'Q' ? course_between(words[i].control, point)
                                  : course_between(words[i - 1].to, point));
    }
    if (i + 1 < words.size() && continues_stroke(words[i + 1].letter)) {
      const char letter = words[i + 1].letter;
      add(letter, letter == 'H'   ? Course::horizontal
                  : letter == 'V' ? Course::vertical
                  : letter == 'Q' ? course_between(point, words[i + 1].control)
                                  : course_between(point, words[i + 1].to));
    }
  }

 private:
  void add(char letter, Course course) {
    vertical |= course == Course::vertical;
    horizontal |= course == Course::horizontal;
    straight |= letter == 'L';
  }
};

double to_halves(double value) { return std::round(2 * value) / 2; }

/// Scales the points to pixels so that stems and bars lie on whole ones. Other points may lie between two, so
/// that an apex stays in the middle.
void fit_to_pixels(std::vector<GlyphWord>& words, double axis, double scale) {
  const double axis_px = std::round(axis * scale);
  const std::vector<GlyphWord> grid = words;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const Meeting meeting(grid, i);
    const double x = (grid[i].to.x - axis) * scale, y = grid[i].to.y * scale;
    words[i].to.x = axis_px + (meeting.vertical || words[i].letter == 'D' ? std::round(x) : to_halves(x));
    words[i].to.y =
        meeting.vertical && !meeting.horizontal && !meeting.straight ? to_halves(y) : std::round(y);
  }
  // A curve that begins or ends upright or level still does.
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (words[i].letter != 'Q') continue;
    const GlyphPoint control = grid[i].control, from = grid[i - 1].to, to = grid[i].to;
    words[i].control.x = control.x == from.x ? words[i - 1].to.x
                         : control.x == to.x ? words[i].to.x
                                             : axis_px + (control.x - axis) * scale;
    words[i].control.y = control.y == from.y ? words[i - 1].to.y
                         : control.y == to.y ? words[i].to.y
                                             : control.y * scale;
  }
}

/// Draws lines into a mask, whose pixel (0, 0) has its upper left corner at the origin.
class MaskDrawing {
 public:
  MaskDrawing(GlyphMask& mask, GlyphPoint origin) : mask_(mask), origin_(origin) {}

  /// A line with round ends. A pixel is covered by how far the line's edge is from its middle, which is exact
  /// along a row or a column and near enough elsewhere.
  void line(GlyphPoint a, GlyphPoint b, double width) {
    const double reach = width / 2 + 0.5;
    a = {a.x - origin_.x, origin_.y - a.y};
    b = {b.x - origin_.x, origin_.y - b.y};
    const double dx = b.x - a.x, dy = b.y - a.y, squared = dx * dx + dy * dy;
    const int first_x = std::max(0, static_cast<int>(std::min(a.x, b.x) - reach));
    const int first_y = std::max(0, static_cast<int>(std::min(a.y, b.y) - reach));
    const int last_x = std::min(mask_.width - 1, static_cast<int>(std::max(a.x, b.x) + reach));
    const int last_y = std::min(mask_.height - 1, static_cast<int>(std::max(a.y, b.y) + reach));
    for (int y = first_y; y <= last_y; ++y)
      for (int x = first_x; x <= last_x; ++x) {
        const double px = x + 0.5 - a.x, py = y + 0.5 - a.y;
        const double along = squared > 0 ? std::clamp((px * dx + py * dy) / squared, 0.0, 1.0) : 0;
        const double distance = std::hypot(px - along * dx, py - along * dy);
        const double covered = std::clamp(reach - distance, 0.0, 1.0);
        std::uint8_t& pixel = mask_.coverage[mask_.index_of(x, y)];
        pixel = std::max(pixel, static_cast<std::uint8_t>(std::lround(255 * covered)));
      }
  }

  /// A cubic curve by Bezier's formula, as lines.
  void curve(GlyphPoint a, GlyphPoint b, GlyphPoint c, GlyphPoint d, double width) {
    constexpr int pieces = 10;
    GlyphPoint last = a;
    for (int piece = 1; piece <= pieces; ++piece) {
      const double t = static_cast<double>(piece) / pieces, u = 1 - t;
      const double wa = u * u * u, wb = 3 * u * u * t, wc = 3 * u * t * t, wd = t * t * t;
      const GlyphPoint next{wa * a.x + wb * b.x + wc * c.x + wd * d.x,
                            wa * a.y + wb * b.y + wc * c.y + wd * d.y};
      line(last, next, width);
      last = next;
    }
  }

 private:
  GlyphMask& mask_;
  GlyphPoint origin_;
};

GlyphPoint between(GlyphPoint a, GlyphPoint b, double share) {
  return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)};
}

}  // namespace

Pen::Pen(double size_px) : scale(size_px / 40) {
  const double wanted = std::max(1.0, 0.088 * size_px);
  line = static_cast<int>(wanted + 0.3);
  width = std::max(wanted, static_cast<double>(line));
}

int width_px(const Glyph& glyph, const Pen& pen) {
  std::string_view strokes = glyph.strokes;
  const double axis = taken_axis(strokes);
  return static_cast<int>(std::lround(axis * pen.scale) + std::lround((glyph.width - axis) * pen.scale)) +
         pen.line;
}

GlyphMask mask_of(const Glyph& glyph, const Pen& pen) {
  std::string_view strokes = glyph.strokes;
  const double axis = taken_axis(strokes);
  std::vector<GlyphWord> words = words_of(strokes);
  fit_to_pixels(words, axis, pen.scale);
  GlyphMask mask;
  if (words.empty()) return mask;
  // Lines as wide as a whole number of pixels then cover these completely.
  const double half_line = pen.line / 2.0;
  GlyphPoint least = words.front().to, most = least;
  for (GlyphWord& word : words) {
    for (GlyphPoint* point : {&word.control, &word.to}) {
      point->x += half_line;
      point->y += half_line;
    }
    for (const GlyphPoint& point : {word.to, word.letter == 'Q' ? word.control : word.to}) {
      least = {std::min(least.x, point.x), std::min(least.y, point.y)};
      most = {std::max(most.x, point.x), std::max(most.y, point.y)};
    }
  }
  const int margin = pen.line + 1;
  mask.left = static_cast<int>(std::floor(least.x)) - margin;
  mask.top = -static_cast<int>(std::ceil(most.y)) - margin;
  mask.width = static_cast<int>(std::ceil(most.x)) + margin - mask.left;
  mask.height = margin - static_cast<int>(std::floor(least.y)) - mask.top;
  mask.coverage.assign(static_cast<std::size_t>(mask.width) * static_cast<std::size_t>(mask.height), 0);
  MaskDrawing drawing(mask, {static_cast<double>(mask.left), static_cast<double>(-mask.top)});
  // A little squarer than an ellipse (0.55), which leaves more white inside of small letters.
  constexpr double roundness = 0.6;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const GlyphWord& word = words[i];
    if (word.letter == 'D') drawing.line(word.to, word.to, 1.4 * pen.width);
    if (!continues_stroke(word.letter)) continue;
    const GlyphPoint from = words[i - 1].to;
    if (word.letter == 'L') {
      drawing.line(from, word.to, pen.width);
    } else if (word.letter == 'Q') {
      drawing.curve(from, between(from, word.control, 2.0 / 3), between(word.to, word.control, 2.0 / 3),
                    word.to, pen.width);
    } else {
      const GlyphPoint corner =
          word.letter == 'H' ? GlyphPoint{word.to.x, from.y} : GlyphPoint{from.x, word.to.y};
      drawing.curve(from, between(from, corner, roundness), between(word.to, corner, roundness), word.to,
                    pen.width);
    }
  }
  return mask;
}

}  // namespace mssim
