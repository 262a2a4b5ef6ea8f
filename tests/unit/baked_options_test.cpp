// Tests reading a bake's options from an asset, and assets without valid ones.
#include "engine/base/error.h"
#include "precompute/bake/bake_options.h"
#include "precompute/bake/baked_options.h"
#include "precompute/brdf/brdf.h"
#include "precompute/brdf/material_list.h"
#include "tests/support/asset_sample.h"
#include "tests/support/capture_binding.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace relume;
using namespace relume::test;

namespace {

Asset assetOf(const BakeOptions& options) {
    Asset asset;
    asset.coefficients = options.coefficients;
    asset.faceSize = options.faceSize;
    asset.visibilitySize = options.visibilitySize;
    asset.transportSamples = options.transportSamples;
    asset.bounces = options.bounces;
    asset.provenance.options = describeOptions(options);
    return asset;
}

} // namespace

TEST_CASE("baked options: they come back") {
    BakeOptions options;
    options.factorization = {7, Factorization::Cosine, 0.0123f};
    options.coefficients = 17;
    options.mapSize = 16;
    options.mapping = DiskMapping::Polar;
    options.faceSize = 32;
    options.visibilitySize = 128;
    options.visibilityMethod = VisibilityMethod::Raster;
    options.transportSamples = 4;
    options.occluderTriangles = 12345;
    BakeOptions budget = options, rows;
    budget.layout.bytesPerVertex = 123.5;
    options.layout.error = 0.03;
    rows.layout = {.layout = TransportLayout::Rows};
    rows.refinement = {0.01, 0.25, 0.0098, 0, 0, true};
    for (const BakeOptions& each : {options, budget, rows, BakeOptions()}) {
        const BakeOptions back = optionsOf(assetOf(each));
        CHECK_EQ(describeOptions(back), describeOptions(each));
        CHECK(back.factorization == each.factorization);
        CHECK(back.layout == each.layout);
        CHECK(back.refinement == each.refinement);
    }
}

TEST_CASE("baked options: a preset is known by its options, and not where one of them differs") {
    for (const BakePreset preset : kBakePresets) {
        BakeOptions options = presetOptions(preset);
        CHECK(presetOf(optionsOf(assetOf(options))) == preset);
        options.refinement.reset(); // as where nothing was coarse
        CHECK(presetOf(optionsOf(assetOf(options))) == preset);
        options.mapSize /= 2;
        CHECK(!presetOf(optionsOf(assetOf(options))));
    }
    BakeOptions refined = presetOptions(BakePreset::Paper);
    refined.refinement = {0.01, 0.25, 0.0098, 0, 0, true};
    CHECK(!presetOf(optionsOf(assetOf(refined))));
}

TEST_CASE("baked options: others are refused") {
    const auto refined = [](const nlohmann::json& wanted, const nlohmann::json& error,
                            const nlohmann::json& vertices) {
        return nlohmann::json{{"wanted_error", wanted},
                              {"start_error", 1},
                              {"error", error},
                              {"start_vertices", 0},
                              {"vertices", vertices}};
    };
    const auto change = [](const char* key, const nlohmann::json& value) {
        Asset asset = assetOf({});
        auto options = nlohmann::json::parse(asset.provenance.options);
        options[key] = value;
        asset.provenance.options = options.dump();
        return asset;
    };
    optionsOf(change("terms", 3)); // that the change itself is no fault
    optionsOf(change("refinement", refined(0.01, 0.01, 0)));
    for (const auto& [key, value] :
         std::vector<std::pair<const char*, nlohmann::json>>{{"terms", 0},
                                                             {"terms", -1},
                                                             {"terms", 1e300},
                                                             {"terms", "4"},
                                                             {"terms", uint64_t(1) << 40},
                                                             {"layout", "cells"},
                                                             {"layout_bytes", -1},
                                                             {"layout_bytes", 1e7},
                                                             {"layout_error", 0},
                                                             {"layout_error", "x"},
                                                             {"error", 0},
                                                             {"error", 2},
                                                             {"error", "0.1"},
                                                             {"factorization", "best"},
                                                             {"factorization", nullptr},
                                                             {"map", 3},
                                                             {"map_size", 65},
                                                             {"coefficients", 97},
                                                             {"face_size", 32},
                                                             {"visibility_size", 128},
                                                             {"transport_samples", 4},
                                                             {"occluder_triangles", -5},
                                                             {"visibility", "auto"},
                                                             {"vertex_order", "none"},
                                                             {"refinement", nullptr},
                                                             {"refinement", 0.01},
                                                             {"refinement", {{"error", 0.01}}},
                                                             {"refinement", refined(2, 0.01, 0)},
                                                             {"refinement", refined(0.01, -1, 0)},
                                                             {"refinement", refined(0.01, "x", 0)},
                                                             {"refinement", refined(0.01, 0.01, 1e300)},
                                                             {"refinement", refined(0.01, 0.01, 0.5)},
                                                             {"refinement", refined(0.01, 0.01, 1)},
                                                             {"more", 1}}) {
        CAPTURE_BINDING(key);
        CAPTURE_BINDING(value.dump());
        CHECK_THROWS_AS(optionsOf(change(key, value)), Error);
    }
    Asset asset = assetOf({});
    for (const std::string& text :
         {std::string("{}"), std::string(), std::string("[1]"), std::string("{\"terms\":4"),
          std::string(5000, '['), asset.provenance.options + " x"}) {
        asset.provenance.options = text;
        CHECK_THROWS_AS(optionsOf(asset), Error);
    }
}

TEST_CASE("baked materials: a description makes the BRDF that it describes, for every preset") {
    for (const MaterialPreset& preset : materialPresets()) {
        CAPTURE(preset.name);
        AssetPart part;
        const std::string description = makeBrdf(preset.name)->describe().dump();
        MaterialSet first, second;
        first.materials = {{"one", description}, {"two", description}};
        second.materials = {{"three", description}};
        part.sets = {first, second};
        const MaterialSets sets = readMaterials(materialsOf(part));
        REQUIRE_EQ(sets.size(), 2);
        REQUIRE_EQ(sets[0].size(), 2);
        CHECK_EQ(sets[0][1].name, "two");
        CHECK_EQ(sets[1][0].name, "three");
        for (const auto& set : sets)
            for (const NamedMaterial& material : set) CHECK_EQ(material.brdf->describe().dump(), description);
    }
    AssetPart part;
    MaterialSet set;
    for (const char* wrong : {"", "clay", "[1]", "{\"model\":"}) {
        set.materials = {{"one", wrong}};
        part.sets = {set};
        CHECK_THROWS_AS(materialsOf(part), Error);
    }
}
