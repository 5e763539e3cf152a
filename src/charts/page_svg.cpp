#include "charts/page_svg.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <set>
#include <vector>

#include "charts/chart_text.h"
#include "charts/series_style.h"
#include "charts/svg_tags.h"

namespace mssim {
namespace {

/// What the elements of a drawing may be called, and those that are left out with all that is in them: a
/// title that says "chart_plot_1", a program's version, filters for boxes of text.
constexpr std::array<std::string_view, 9> kept_elements{"svg", "g",      "defs", "path",   "text",
                                                        "use", "circle", "rect", "polygon"};
constexpr std::array<std::string_view, 3> dropped_elements{"title", "desc", "filter"};

bool is_one_of(std::span<const std::string_view> names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

/// The number of the fill that a colour of gnuplot_script() stands for.
std::optional<std::size_t> fill_number(std::string_view colour) {
  constexpr std::string_view before = "rgb( 1, 2, ";
  std::string_view number = colour;
  std::size_t fill = 0;
  if (!number.starts_with(before)) return std::nullopt;
  number.remove_prefix(before.size());
  const auto end = std::from_chars(number.data(), number.data() + number.size(), fill);
  return end.ec == std::errc() ? std::optional(fill) : std::nullopt;
}

/// Six patterns that differ without colours; measured values have a shade behind the lines.
std::string fill_pattern(const std::string& id, std::size_t fill) {
  constexpr std::array<std::string_view, bar_patterns> lines{"",
                                                             "M-1,1 L1,-1 M0,6 L6,0 M5,7 L7,5",
                                                             "M0,1.5 H6 M0,4.5 H6",
                                                             "M-1,5 L1,7 M0,0 L6,6 M5,-1 L7,1",
                                                             "M1.5,0 V6 M4.5,0 V6",
                                                             "M0,0 L6,6 M0,6 L6,0"};
  const SeriesStyle style = style_of_fill(fill);
  const std::string colour(style.colour());
  const bool solid = lines[style.pattern()].empty();
  std::string pattern =
      "<pattern id=\"" + id + "\" width=\"6\" height=\"6\" patternUnits=\"userSpaceOnUse\">";
  if (style.origin == Origin::measured)
    pattern += "<rect width=\"6\" height=\"6\" fill=\"" + colour + "\" fill-opacity=\"" +
               (solid ? "1" : "0.3") + "\"/>";
  if (!solid)
    pattern += "<path d=\"" + std::string(lines[style.pattern()]) + "\" fill=\"none\" stroke=\"" + colour +
               "\" stroke-width=\"" + (style.origin == Origin::measured ? "1.5" : "0.8") + "\"/>";
  return pattern + "</pattern>";
}

class Redrawing {
 public:
  Redrawing(std::string_view drawing, const ChartWords& words) : drawing_(drawing), words_(words) {}

  std::optional<std::string> made() {
    // What comes before is the declaration of a file.
    std::string_view rest = drawing_.substr(std::min(drawing_.find("<svg"), drawing_.size()));
    bool complete = false;
    while (auto piece = take_piece(rest)) {
      if (is_one_of(dropped_elements, piece->tag.name)) {
        const std::string end = "</" + piece->tag.name + ">";
        const std::size_t found = rest.find(end);
        if (found == std::string_view::npos) return std::nullopt;
        rest.remove_prefix(found + end.size());
        continue;
      }
      if (!is_one_of(kept_elements, piece->tag.name) || !add(*piece)) return std::nullopt;
      complete = piece->tag.name == "svg" && !piece->tag.opens;
    }
    if (!complete) return std::nullopt;
    return std::move(page_);
  }

 private:
  bool add(SvgPiece& piece) {
    SvgTag& tag = piece.tag;
    if (tag.name == "text" && !tag.opens) add_text(piece.text);
    if (tag.name == "svg") return add_root(tag);
    if (!tag.opens) return end_element(tag);
    if (is_unused(tag)) return true;
    restyle(tag);
    if (!tag.closes) opened_.push_back({page_.size(), tag.name});
    page_ += tag.written();
    if (!tag.closes) opened_.back().inside = page_.size();
    return true;
  }

  /// gnuplot leaves > as it is, which XML forbids behind ]].
  void add_text(std::string_view text) {
    for (const char character : text) page_ += character == '>' ? "&gt;" : std::string(1, character);
  }

  bool add_root(SvgTag& tag) {
    if (!tag.opens) {
      if (!opened_.empty()) return false;
      if (!fills_.empty()) {
        page_ += "<defs>";
        for (const std::size_t fill : fills_) page_ += fill_pattern(fill_id(fill), fill);
        page_ += "</defs>";
      }
      page_ += "</svg>";
      return true;
    }
    const std::string* view_box = tag.find("viewBox");
    if (!page_.empty() || !view_box) return false;
    page_ = "<svg id=\"" + words_.id + "\" class=\"chart\" viewBox=\"" + *view_box +
            "\" xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" aria-labelledby=\"" + words_.id +
            "-title\" aria-describedby=\"" + words_.id +
            "-description\" font-family=\"system-ui, sans-serif\"><title id=\"" + words_.id + "-title\">" +
            xml_text(words_.title) + "</title><desc id=\"" + words_.id + "-description\">" +
            xml_text(words_.description) + "</desc>\n";
    return true;
  }

  /// Takes an element away again that has nothing in it.
  bool end_element(const SvgTag& tag) {
    if (opened_.empty() || opened_.back().name != tag.name) return false;
    if (tag.name != "text" && page_.size() == opened_.back().inside)
      page_.resize(opened_.back().begin);
    else
      page_ += tag.written() + (tag.name == "g" ? "\n" : "");
    opened_.pop_back();
    return true;
  }

  void restyle(SvgTag& tag) {
    if (std::string* id = tag.find("id")) {
      // Groups have ids for scripts, which a page has none of.
      if (tag.name == "g")
        tag.remove("id");
      else
        *id = words_.id + '-' + *id;
    }
    if (const std::string* family = tag.find("font-family"); family && family->ends_with(":Bold"))
      tag.attributes.emplace_back("font-weight", "bold");
    tag.remove("font-family");
    tag.remove("shape-rendering");
    if (tag.name == "g") tag.remove("color");  // it would be the currentColor of what is in it
    for (auto& [name, value] : tag.attributes) {
      if (name == "xlink:href") {
        name = "href";
        value = "#" + words_.id + '-' + value.substr(std::min<std::size_t>(1, value.size()));
      } else if (name == "stroke" || name == "fill" || name == "color") {
        if (value == "black" || value == "rgb( 0, 0, 0)") value = "currentColor";
        if (const auto fill = fill_number(value)) {
          fills_.insert(*fill);
          value = "url(#" + fill_id(*fill) + ')';
        }
      }
    }
    if (const std::string* kind = tag.find("class"); kind && *kind == "gridline") {
      tag.remove("class");
      tag.remove("stroke");
      tag.attributes.insert(tag.attributes.end(), {{"stroke", "currentColor"}, {"stroke-opacity", "0.2"}});
    }
  }

  /// What gnuplot draws in the middle of an interval, where the point of the series is: a dot on a white
  /// disc; shapes of points that no point has; the empty rectangle behind everything.
  bool is_unused(SvgTag& tag) const {
    const auto is = [&](std::string_view attribute, std::string_view value) {
      const std::string* found = tag.find(attribute);
      return found && *found == value;
    };
    if (tag.name == "use" && (is("xlink:href", "#gpDot") || is("color", "white"))) return true;
    if (const std::string* id = tag.find("id"); id && tag.name != "g")
      return *id == "gpDot" || drawing_.find('#' + *id + '\'') == std::string_view::npos;
    return tag.name == "rect" && is("fill", "none");
  }

  std::string fill_id(std::size_t fill) const { return words_.id + "-fill-" + std::to_string(fill); }

  struct Opened {
    std::size_t begin;
    std::string name;
    std::size_t inside = 0;
  };

  std::string_view drawing_;
  const ChartWords& words_;
  std::string page_;
  std::vector<Opened> opened_;
  std::set<std::size_t> fills_;
};

}  // namespace

std::optional<std::string> page_svg(std::string_view drawing, const ChartWords& words) {
  return Redrawing(drawing, words).made();
}

}  // namespace mssim
