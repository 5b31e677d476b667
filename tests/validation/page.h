#pragma once

#include <string>

#include "core/base/result.h"

namespace lamella {

/// Replaces what stands between the comments "table NAME" and "end" of a page.
inline Result<void> set_table(std::string& page, const std::string& name,
                              const std::string& table) {
  const std::string begin = "<!-- table " + name + " -->\n", end = "<!-- end -->";
  const std::size_t from = page.find(begin);
  const std::size_t to = from == std::string::npos ? from : page.find(end, from);
  if (to == std::string::npos)
    return Error{Code::bad_input, "The page has no place for the table \"" + name + "\".",
                 "It stands between the lines <!-- table " + name + " --> and " + end + "."};
  page.replace(from + begin.size(), to - from - begin.size(), table);
  return {};
}

}  // namespace lamella
