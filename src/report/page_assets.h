// Style and script of report.html.
#pragma once
#include <string_view>

namespace tessera::report
{

extern const std::string_view kPageStyle;
extern const std::string_view kPageScript;  // pictures and choices; the page's text and plots stand without it

}  // namespace tessera::report
