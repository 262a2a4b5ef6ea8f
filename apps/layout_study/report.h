// The study's results as a table of all values, as figures, and as a summary.
#pragma once

#include "apps/layout_study/study.h"

namespace relume {

// bake,vertices,terms,layout,bytes,on_disk,transport_error,environment,relit_error,image_error: a line per
// variant and light.
std::string csvOf(const std::vector<BakeStudy>& studies, const StudyOptions& options);

// Errors over bytes a vertex, a panel per bake and light.
std::string relitPlot(const std::vector<BakeStudy>& studies, const StudyOptions& options);
std::string imagePlot(const std::vector<BakeStudy>& studies, const StudyOptions& options);

// Markdown: a table per bake.
std::string summaryOf(const std::vector<BakeStudy>& studies, const StudyOptions& options);

} // namespace relume
