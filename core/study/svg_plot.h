#pragma once

#include <string>
#include <vector>

namespace lamella {

/// Plots as inline SVG for the report; no script, no outside resource.

/// Bars over equal bins of [low, high]; values outside count in the first or last bin.
struct Histogram {
  double low = 0, high = 1;
  std::vector<std::size_t> counts;

  Histogram(double low_bound, double high_bound, std::size_t bins)
      : low(low_bound), high(high_bound), counts(bins, 0) {}
  /// NaN is passed over.
  void add(double value);
};

/// `mark` draws a dashed line at that value, with its label; an empty label draws none.
std::string svg_histogram(const Histogram& histogram, const std::string& axis, double mark = 0,
                          const std::string& label = {});

/// One line of a plot over the iterations 0, 1, ...
struct Series {
  std::string name;
  std::vector<double> values;
  bool right = false;  ///< on the right axis
};

/// Lines over the iteration number, with a left and a right axis from zero. `goal` draws a dashed
/// line on the right axis.
std::string svg_convergence(const std::vector<Series>& series, const std::string& left_axis,
                            const std::string& right_axis, double goal);

/// Lines over the iteration number, from `first` on, on a logarithmic axis; later series are drawn
/// dashed over the earlier ones, so that equal ones are seen both. Values that are not positive and
/// finite leave a gap.
std::string svg_log_convergence(const std::vector<Series>& series, const std::string& axis,
                                std::size_t first = 0);

/// Plots of this header side by side as the text of an SVG file of its own, with the styles that
/// the report has in its page.
std::string svg_document(const std::vector<std::string>& plots, const std::string& title);

/// 1234567 as "1,234,567".
std::string grouped(std::size_t n);
/// Short decimal text with `digits` significant digits.
std::string short_number(double value, int digits = 4);
/// Text made safe for HTML and SVG.
std::string escaped(const std::string& text);

}  // namespace lamella
