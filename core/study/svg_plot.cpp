#include "core/study/svg_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace lamella {

namespace {

constexpr double kWidth = 460, kHeight = 230;
constexpr double kLeft = 58, kRight = 14, kTop = 16, kBottom = 40;
const char* const kColors[] = {"#0f6b8f", "#d0721b", "#5a7d2b", "#7a5195", "#b3293d"};
const char* const kDashes[] = {"none", "7 3", "2.5 3", "10 3 2 3", "5 5"};

std::string f(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", v);
  return text;
}

std::string text(double x, double y, const char* anchor, const std::string& words,
                 const std::string& more = {}) {
  return "<text x=\"" + f(x) + "\" y=\"" + f(y) + "\" text-anchor=\"" + anchor + "\"" + more + ">" +
         escaped(words) + "</text>";
}

std::string line(double x1, double y1, double x2, double y2, const std::string& style) {
  return "<line x1=\"" + f(x1) + "\" y1=\"" + f(y1) + "\" x2=\"" + f(x2) + "\" y2=\"" + f(y2) +
         "\" " + style + "/>";
}

std::string open_svg(const std::string& title) {
  return "<svg viewBox=\"0 0 " + f(kWidth) + " " + f(kHeight) + "\" role=\"img\" aria-label=\"" +
         escaped(title) + "\">";
}

bool drawable(double v) { return v > 0 && std::isfinite(v); }

/// A round step that divides [0, top] into about `parts`.
double nice_step(double top, int parts) {
  const double raw = std::max(top, 1e-12) / parts;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double m : {1.0, 2.0, 2.5, 5.0})
    if (m * power >= raw * (1 - 1e-9)) return m * power;
  return 10 * power;
}

/// Values to mark on a logarithmic axis that holds [low, high], the first <= low, the last >= high.
std::vector<double> log_ticks(double low, double high) {
  std::vector<double> ticks;
  if (high < 4 * low) {
    const double step = nice_step(std::max(high - low, 1e-3 * high), 4);
    double k = std::floor(low / step + 1e-9);
    while (k > 0 && (ticks.size() < 2 || ticks.back() < high)) ticks.push_back(step * k++);
    if (!ticks.empty()) return ticks;
  }
  for (int decade = static_cast<int>(std::floor(std::log10(low)));; ++decade)
    for (const double m : {1.0, 2.0, 5.0}) {
      const double v = m * std::pow(10.0, decade);
      if (v <= low * (1 + 1e-9)) ticks.clear();
      ticks.push_back(v);
      if (v >= high * (1 - 1e-9) && ticks.size() > 1) return ticks;
    }
}

std::string compact(double v) {
  if (v >= 1e6) return short_number(v / 1e6, 3) + "M";
  if (v >= 1e3) return short_number(v / 1e3, 3) + "k";
  return short_number(v, 3);
}

}  // namespace

void Histogram::add(double value) {
  if (std::isnan(value) || counts.empty()) return;
  const double t = (value - low) / (high - low) * static_cast<double>(counts.size());
  const double last = static_cast<double>(counts.size()) - 1;
  ++counts[static_cast<std::size_t>(std::clamp(std::floor(t), 0.0, last))];
}

std::string svg_histogram(const Histogram& histogram, const std::string& axis, double mark,
                          const std::string& label) {
  std::size_t total = 0, largest = 1;
  for (const std::size_t n : histogram.counts) {
    total += n;
    largest = std::max(largest, n);
  }
  // Shares, so that bodies of any size read alike.
  const double top_share =
      100.0 * static_cast<double>(largest) / static_cast<double>(std::max<std::size_t>(total, 1));
  const double step = nice_step(top_share, 4);
  const double top = step * std::ceil(top_share / step - 1e-9);
  const double plot_w = kWidth - kLeft - kRight, plot_h = kHeight - kTop - kBottom;
  const auto x_of = [&](double v) {
    return kLeft + plot_w * (v - histogram.low) / (histogram.high - histogram.low);
  };
  const auto y_of = [&](double share) { return kTop + plot_h * (1 - share / top); };

  std::string svg = open_svg("Histogram of " + axis);
  for (double s = 0; s <= top * (1 + 1e-9); s += step) {
    svg += line(kLeft, y_of(s), kWidth - kRight, y_of(s), "class=\"grid\"");
    svg += text(kLeft - 6, y_of(s) + 4, "end", short_number(s, 3) + "%");
  }
  const double bar = plot_w / static_cast<double>(histogram.counts.size());
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    const std::size_t n = histogram.counts[i];
    const double share =
        100.0 * static_cast<double>(n) / static_cast<double>(std::max<std::size_t>(total, 1));
    const double height = n > 0 ? std::max(plot_h * share / top, 1.0) : 0;
    svg += "<rect class=\"bar\" x=\"" + f(kLeft + bar * static_cast<double>(i) + 0.7) + "\" y=\"" +
           f(kTop + plot_h - height) + "\" width=\"" + f(bar - 1.4) + "\" height=\"" + f(height) +
           "\"><title>" + grouped(n) + "</title></rect>";
  }
  svg += line(kLeft, kTop + plot_h, kWidth - kRight, kTop + plot_h, "class=\"axis\"");
  const double x_step = nice_step(histogram.high - histogram.low, 6);
  for (double v = histogram.low; v <= histogram.high + 1e-9; v += x_step)
    svg += text(x_of(v), kTop + plot_h + 15, "middle", short_number(v, 3));
  svg += text(kLeft + plot_w / 2, kHeight - 6, "middle", axis, " class=\"label\"");
  if (!label.empty() && mark >= histogram.low && mark <= histogram.high) {
    svg += line(x_of(mark), kTop - 4, x_of(mark), kTop + plot_h, "class=\"mark\"");
    const bool late = x_of(mark) > kLeft + 0.7 * plot_w;
    svg += text(x_of(mark) + (late ? -5 : 5), kTop + 5, late ? "end" : "start", label,
                " class=\"note\"");
  }
  return svg + "</svg>";
}

std::string svg_convergence(const std::vector<Series>& series, const std::string& left_axis,
                            const std::string& right_axis, double goal) {
  double left_max = 0, right_max = goal;
  std::size_t points = 1;
  for (const Series& s : series)
    for (const double v : s.values) {
      (s.right ? right_max : left_max) = std::max(s.right ? right_max : left_max, v);
      points = std::max(points, s.values.size());
    }
  // Both axes get the same number of steps, so that one grid serves them.
  const int steps = 5;
  const double left_step = nice_step(left_max, steps), right_step = nice_step(right_max, steps);
  const double right_margin = 52, top = kTop + 18;
  const double plot_w = kWidth - kLeft - right_margin, plot_h = kHeight - top - kBottom;
  const auto x_of = [&](std::size_t i) {
    return kLeft + plot_w * static_cast<double>(i) /
                       static_cast<double>(std::max<std::size_t>(points - 1, 1));
  };
  const auto y_of = [&](double v, bool right) {
    return top + plot_h * (1 - v / (steps * (right ? right_step : left_step)));
  };

  std::string svg = open_svg("Convergence");
  for (int k = 0; k <= steps; ++k) {
    const double y = top + plot_h * (1 - static_cast<double>(k) / steps);
    svg += line(kLeft, y, kLeft + plot_w, y, "class=\"grid\"");
    svg += text(kLeft - 6, y + 4, "end", compact(k * left_step));
    svg += text(kLeft + plot_w + 6, y + 4, "start", short_number(k * right_step, 3));
  }
  for (std::size_t i = 0; i < points; ++i)
    svg += text(x_of(i), top + plot_h + 15, "middle", std::to_string(i));
  svg += line(kLeft, top + plot_h, kLeft + plot_w, top + plot_h, "class=\"axis\"");
  svg += text(kLeft + plot_w / 2, kHeight - 6, "middle", "iteration", " class=\"label\"");
  if (goal > 0) {
    svg += line(kLeft, y_of(goal, true), kLeft + plot_w, y_of(goal, true), "class=\"mark\"");
    svg += text(kLeft + plot_w - 4, y_of(goal, true) - 4, "end", "layers asked", " class=\"note\"");
  }
  double legend = kLeft;
  for (std::size_t s = 0; s < series.size(); ++s) {
    const std::string color = kColors[s % std::size(kColors)];
    std::string path;
    for (std::size_t i = 0; i < series[s].values.size(); ++i)
      path += (i ? " " : "") + f(x_of(i)) + "," + f(y_of(series[s].values[i], series[s].right));
    svg += "<polyline points=\"" + path + "\" fill=\"none\" stroke=\"" + color +
           "\" stroke-width=\"2\"/>";
    for (std::size_t i = 0; i < series[s].values.size(); ++i)
      svg += "<circle cx=\"" + f(x_of(i)) + "\" cy=\"" +
             f(y_of(series[s].values[i], series[s].right)) + "\" r=\"3\" fill=\"" + color +
             "\"><title>" + escaped(series[s].name) + " " + short_number(series[s].values[i], 5) +
             "</title></circle>";
    svg += line(legend, 9, legend + 16, 9, "stroke=\"" + color + "\" stroke-width=\"3\"");
    const std::string name =
        series[s].name + " (" + (series[s].right ? right_axis : left_axis) + ")";
    svg += text(legend + 21, 13, "start", name);
    legend += 34 + 6.2 * static_cast<double>(name.size());
  }
  return svg + "</svg>";
}

std::string svg_log_convergence(const std::vector<Series>& series, const std::string& axis,
                                std::size_t first) {
  double low = std::numeric_limits<double>::infinity(), high = 0;
  std::size_t last = first + 1;
  for (const Series& s : series)
    for (std::size_t i = first; i < s.values.size(); ++i) {
      last = std::max(last, i);
      if (!drawable(s.values[i])) continue;
      low = std::min(low, s.values[i]);
      high = std::max(high, s.values[i]);
    }
  if (high == 0) low = high = 1;
  const std::vector<double> ticks = log_ticks(low, high);
  const double base = std::log(ticks.front()), span = std::log(ticks.back()) - base;
  const double top = kTop + 34, plot_w = kWidth - kLeft - kRight, plot_h = kHeight - top - kBottom;
  const auto x_of = [&](std::size_t i) {
    return kLeft + plot_w * static_cast<double>(i - first) / static_cast<double>(last - first);
  };
  const auto y_of = [&](double v) { return top + plot_h * (1 - (std::log(v) - base) / span); };

  std::string svg = open_svg(axis);
  svg += text(kLeft, 13, "start", axis, " class=\"label\"");
  double free_below = kHeight;
  for (const double v : ticks) {
    svg += line(kLeft, y_of(v), kLeft + plot_w, y_of(v), "class=\"grid\"");
    // A label that would touch the one below is left out, the powers of ten last.
    const bool power = std::abs(std::log10(v) - std::round(std::log10(v))) < 1e-9;
    if (y_of(v) > free_below || (!power && ticks.size() > 8)) continue;
    svg += text(kLeft - 6, y_of(v) + 4, "end", compact(v));
    free_below = y_of(v) - 12;
  }
  for (std::size_t i = first; i <= last; ++i)
    svg += text(x_of(i), top + plot_h + 15, "middle", std::to_string(i));
  svg += line(kLeft, top + plot_h, kLeft + plot_w, top + plot_h, "class=\"axis\"");
  svg += text(kLeft + plot_w / 2, kHeight - 6, "middle", "iteration", " class=\"label\"");
  double legend = kLeft;
  for (std::size_t s = 0; s < series.size(); ++s) {
    const std::string style =
        "fill=\"none\" stroke=\"" + std::string(kColors[s % std::size(kColors)]) +
        "\" stroke-width=\"2\" stroke-dasharray=\"" + kDashes[s % std::size(kDashes)] + "\"";
    std::string path;
    bool pen_down = false;
    for (std::size_t i = first; i < series[s].values.size(); ++i) {
      const double v = series[s].values[i];
      if (drawable(v)) path += (pen_down ? "L" : "M") + f(x_of(i)) + " " + f(y_of(v));
      pen_down = drawable(v);
    }
    svg += "<path d=\"" + path + "\" " + style + "><title>" + escaped(series[s].name) +
           "</title></path>";
    svg += line(legend, 31, legend + 26, 31, style);
    svg += text(legend + 31, 35, "start", series[s].name);
    legend += 46 + 6.6 * static_cast<double>(series[s].name.size());
  }
  return svg + "</svg>";
}

std::string svg_document(const std::vector<std::string>& plots, const std::string& title) {
  const double width = (kWidth + 20) * static_cast<double>(plots.size());
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + f(width) + " " +
                    f(kHeight) + "\" width=\"" + f(width) + "\" height=\"" + f(kHeight) +
                    "\">\n<title>" + escaped(title) +
                    "</title>\n<style>text{font:12px sans-serif;fill:#4a5560}"
                    ".grid{stroke:#dde3e8}.axis{stroke:#1c2733}.bar{fill:#0f6b8f}"
                    ".mark{stroke:#b3293d;stroke-dasharray:5 4}.note{fill:#b3293d}"
                    ".label{fill:#1c2733}</style>\n"
                    "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
  double x = 0;
  for (const std::string& plot : plots) {
    svg += "<svg x=\"" + f(x) + "\" width=\"" + f(kWidth) + "\" height=\"" + f(kHeight) + "\"" +
           plot.substr(4) + "\n";
    x += kWidth + 20;
  }
  return svg + "</svg>\n";
}

std::string grouped(std::size_t n) {
  std::string digits = std::to_string(n);
  for (int at = static_cast<int>(digits.size()) - 3; at > 0; at -= 3)
    digits.insert(static_cast<std::size_t>(at), ",");
  return digits;
}

std::string short_number(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += c;
    }
  return safe;
}

}  // namespace lamella
