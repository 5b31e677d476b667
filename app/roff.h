#pragma once

#include <string>

namespace lamella::roff {

/// Words as roff takes them for what they are: hyphens to be copied, no requests, no escapes.
inline std::string plain(const std::string& text) {
  std::string out;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && (c == '.' || c == '\'')) out += "\\&";
    if (c == '-')
      out += "\\-";
    else if (c == '\\')
      out += "\\e";
    else
      out += c;
    line_begins = c == '\n';
  }
  return out;
}

inline std::string bold(const std::string& text) { return "\\fB" + plain(text) + "\\fR"; }
inline std::string italic(const std::string& text) { return "\\fI" + plain(text) + "\\fR"; }

}  // namespace lamella::roff
