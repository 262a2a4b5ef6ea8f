#include "apps/evaluation/sections.h"

namespace relume {

const std::vector<SectionEntry>& sectionList() {
    static const std::vector<SectionEntry> kSections = {
        {"table-1", "bake times and sizes", bakeTable},
        {"table-2", "view and light changes", frameTable},
        {"figure-2", "the number of BRDF terms", termsFigure},
        {"figure-3", "the number of wavelet coefficients", shadowFigure},
        {"figure-4", "BRDFs factored", brdfFigure},
        {"figure-5", "diffuse, one polar term, four terms", parametersFigure},
        {"scenes", "the scenes of figures 1, 6 and 7", sceneFigures},
        {"sources", "where error comes from, and 25 spherical harmonics", errorSources},
        {"refinement", "refined grounds against uniform ones", refinedGround},
        {"layouts", "the paper's transport against the layouts and factorisations of now", layoutComparison},
    };
    return kSections;
}

} // namespace relume
