// A report as a single HTML file that needs nothing else: styles and images are in it, scripts there are
// none.
#pragma once

#include "apps/evaluation/report.h"

namespace relume {

// Pictures are read from `folder`. All text is escaped. Throws Error when a picture cannot be read.
std::string htmlOf(const Report& report, const std::filesystem::path& folder);

} // namespace relume
