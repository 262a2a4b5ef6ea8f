// The sections of the report, a file each. To add one: declare it here, name it in sections.cpp.
#pragma once

#include "apps/evaluation/evaluation.h"

namespace relume {

Section bakeTable(const SectionInputs& inputs);        // table_bake.cpp
Section frameTable(const SectionInputs& inputs);       // table_frames.cpp
Section termsFigure(const SectionInputs& inputs);      // figure_terms.cpp
Section shadowFigure(const SectionInputs& inputs);     // figure_shadow.cpp
Section brdfFigure(const SectionInputs& inputs);       // figure_brdfs.cpp
Section parametersFigure(const SectionInputs& inputs); // figure_parameters.cpp
Section sceneFigures(const SectionInputs& inputs);     // figure_scenes.cpp
Section layoutComparison(const SectionInputs& inputs); // layout_comparison.cpp
Section errorSources(const SectionInputs& inputs);     // error_sources.cpp
Section refinedGround(const SectionInputs& inputs);    // refined_ground.cpp

// All of them by name, in the report's order.
struct SectionEntry {
    const char* name; // Section::name
    const char* what; // for --help
    Section (*make)(const SectionInputs&);
};
const std::vector<SectionEntry>& sectionList();

} // namespace relume
