// The light for error studies, from options.
#pragma once

#include "apps/relume/options.h"
#include "apps/relume/selection_arguments.h"
#include "precompute/error/error_study.h"

namespace relume {

struct StudiedLightArguments {
    LightArguments light;
    SelectionArguments selection;

    void add(CLI::App& command);
    // Returns the light at the time given by the options. The fine cube of a single environment has as much
    // of its resolution as 6 × kTruthFaceSize² texels can hold. Throws Error for a black light.
    StudiedLight studied() const;

  private:
    StudiedLight sampled() const;
};

} // namespace relume
