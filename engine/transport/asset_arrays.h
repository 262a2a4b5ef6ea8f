// The arrays of an asset and the tags of their chunks, in file order.
#pragma once

#include "engine/chunk/chunk_file.h"
#include "engine/transport/asset.h"

#include <set>

namespace relume {

constexpr ChunkTag kMeta = chunkTag("META");
constexpr ChunkTag kOccluderPositions = chunkTag("OPOS"), kOccluderTriangles = chunkTag("OTRI");
constexpr ChunkTag kPositions = chunkTag("MPOS"), kNormals = chunkTag("MNRM"), kTriangles = chunkTag("MTRI"),
                   kUvs = chunkTag("MUVS"), kColors = chunkTag("MCOL"), kTangents = chunkTag("MTAN");
constexpr ChunkTag kBaseColor = chunkTag("TBAS"), kMaterialMap = chunkTag("TMAP"),
                   kNormalMap = chunkTag("TNRM"), kEmissionMap = chunkTag("TEMI");
constexpr ChunkTag kLightMaps = chunkTag("LMAP"), kViewMaps = chunkTag("VMAP"),
                   kEigenvalues = chunkTag("EIGV");
constexpr ChunkTag kResidualKernels = chunkTag("RKER"), kIrradianceWeights = chunkTag("RIRR");
constexpr ChunkTag kDirectShares = chunkTag("dshr");
constexpr ChunkTag kVisibility = chunkTag("visb");
// Only in a shard of a bake.
constexpr ChunkTag kShard = chunkTag("SHRD"), kBlockLosses = chunkTag("LOSS");

// Calls array(tag, owner, vector) for every array except transport, and transport(number, set) at the place
// of a set's transport. Sets are numbered over all parts.
template <typename Array, typename Transport>
void forEachArray(const Asset& asset, const Array& array, const Transport& transport) {
    array(kOccluderPositions, kWholeFile, asset.occluder.positions);
    array(kOccluderTriangles, kWholeFile, asset.occluder.triangles);
    uint32_t setNumber = 0;
    std::set<const ResidualSet*> residuals; // a shared residual is stored with the first of its sets
    for (uint32_t number = 0; number < asset.parts.size(); number++) {
        const AssetPart& part = asset.parts[number];
        array(kPositions, number, part.mesh.positions);
        array(kNormals, number, part.mesh.normals);
        array(kTriangles, number, part.mesh.triangles);
        array(kUvs, number, part.mesh.uvs);
        array(kColors, number, part.mesh.colors);
        array(kTangents, number, part.mesh.tangents);
        if (part.baseColor) array(kBaseColor, number, part.baseColor->texels);
        if (part.materialMap) array(kMaterialMap, number, part.materialMap->texels);
        if (part.detail.normalMap) array(kNormalMap, number, part.detail.normalMap->texels);
        if (part.detail.emissionMap) array(kEmissionMap, number, part.detail.emissionMap->texels);
        for (const MaterialSet& set : part.sets) {
            array(kLightMaps, setNumber, set.brdf.lightMaps);
            array(kViewMaps, setNumber, set.brdf.viewMaps);
            array(kEigenvalues, setNumber, set.brdf.eigenvalues);
            if (set.residual && residuals.insert(set.residual.get()).second) {
                std::vector<vec3> values;
                for (const auto& kernel : set.residual->layers)
                    values.insert(values.end(), kernel->values.begin(), kernel->values.end());
                array(kResidualKernels, setNumber, values);
                array(kIrradianceWeights, setNumber, set.residual->irradianceWeights);
            }
            array(kDirectShares, setNumber, set.directShares);
            transport(setNumber, set);
            setNumber++;
        }
    }
}

} // namespace relume
