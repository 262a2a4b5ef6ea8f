// Images of one view under one light, from one bake or several, held against one reference.
#pragma once

#include "apps/evaluation/evaluation.h"
#include "apps/evaluation/relit_scene.h"

namespace relume {

// A light that is made when a step needs it.
struct LightChoice {
    nlohmann::ordered_json key; // decides it
    std::function<SceneLight()> make;
};
LightChoice environmentChoice(const SceneInput& input, float rotationDegrees = 0);
LightChoice areaChoice(float azimuth, float elevation, float radius);
LightChoice distantChoice(float azimuth, float elevation, int face);

struct FigureImage {
    std::string name;  // a file's
    std::string title; // of the picture
    BakeRecipe recipe;
    RelitOptions relit;
    bool isCompared = true; // whether the reference is its truth
    bool isShown = true;
};

struct FigureSetup {
    std::string name, title; // of its steps
    ImageSize size;
    float azimuth = 30, elevation = 20, distance = 1; // orbitOf()
    LightChoice light;
    std::vector<FigureImage> images; // those of one recipe side by side
    ReferenceEffort effort;
    double seconds = 10;     // of a bake; Step::seconds
    bool showsErrors = true; // as heat, beside the images
    size_t truth = 0;        // the image whose scene the reference is made of
};

// A step for each bake, and one for reference and errors.
std::vector<Step> figureSteps(const FigureSetup& setup);

// One for images that are traced as the reference is, with the first RelitOptions::terms, 1 or more, of the
// BRDFs: what these alone lose. Nothing is baked. All of the first image's recipe, whose BRDFs have one layer
// each. For light of few texels: every one costs 16 rays a pixel.
Step tracedFigureStep(const FigureSetup& setup);

// Of those steps, done.
MeasuredError errorOf(const FigureSetup& setup, const StepResults& results, const std::string& image);
// The images with their errors, the reference last; below them, if they are shown, the differences.
ReportFigure figureOf(const FigureSetup& setup, const StepResults& results, const std::string& title);

} // namespace relume
