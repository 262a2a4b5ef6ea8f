// The study's results as a table of all values, as figures, and as a summary.
#pragma once

#include "apps/factorization_study/study.h"

#include <string>

namespace relume {

// material,approach,size,factored_terms,terms,measure,environment,error: a line per value.
std::string csvOf(const std::vector<MaterialStudy>& studies, const StudyOptions& options);

// RMS of the paper's way and the default at every size, and radiance under one light by every approach; a
// panel per material.
std::string rmsPlot(const std::vector<MaterialStudy>& studies, const StudyOptions& options);
std::string radiancePlot(const std::vector<MaterialStudy>& studies, const StudyOptions& options,
                         size_t light);

// Markdown tables.
std::string summaryOf(const std::vector<MaterialStudy>& studies, const StudyOptions& options);

} // namespace relume
