#include "precompute/layout/bases/basis_encoder.h"

#include "engine/transport/bases/basis_chunk.h"
#include "precompute/transport/light_spectrum.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>

namespace relume {

namespace {

using Column = Eigen::Ref<Eigen::VectorXf>;

// Rounds values to multiples of a step, at most kBasisMaximum of them, and returns the step. Leaves the
// rounding errors in `values`.
float quantize(Column values, std::span<int8_t> steps, size_t stride) {
    const float step = values.size() == 0 ? 0 : values.cwiseAbs().maxCoeff() / float(kBasisMaximum);
    const float inverse = step > 0 ? 1 / step : 0;
    for (Eigen::Index i = 0; i < values.size(); i++) {
        // If the step is so small that its inverse is infinite, all values become 0.
        const float rounded = std::isfinite(inverse) ? std::round(values[i] * inverse) : 0;
        const float limited = std::clamp(rounded, -float(kBasisMaximum), float(kBasisMaximum));
        steps[size_t(i) * stride] = int8_t(limited);
        values[i] -= limited * step;
    }
    return step;
}

// Basis vectors with quantized values.
struct QuantizedBasis {
    std::vector<int8_t> values;
    std::vector<float> steps;
    Eigen::MatrixXf
        vectors; // columns × vectors, weighted by the spectrum; the first with all its components'
};

QuantizedBasis quantizeBasis(const Eigen::MatrixXf& vectors, const Eigen::VectorXf& weights,
                             uint32_t components) {
    QuantizedBasis basis;
    basis.values.resize(size_t(vectors.rows()) * components);
    const auto quantized = [&](Column values) {
        const size_t component = basis.steps.size();
        basis.steps.push_back(quantize(values, std::span(basis.values).subspan(component), components));
    };
    basis.vectors.resize(vectors.rows(), vectors.cols());
    for (Eigen::Index vector = 0; vector < vectors.cols(); vector++) {
        const Eigen::VectorXf values = vectors.col(vector).cwiseQuotient(weights);
        Eigen::VectorXf lost = values;
        quantized(lost);
        if (vector == 0 && components > 1) quantized(lost); // the second byte
        basis.vectors.col(vector) = (values - lost).cwiseProduct(weights);
        if (vector == 0 && components > 2) { // repeated for the second byte of the weights
            basis.steps.push_back(basis.steps.front());
            for (Eigen::Index column = 0; column < vectors.rows(); column++)
                basis.values[size_t(column) * components + 2] = basis.values[size_t(column) * components];
        }
    }
    return basis;
}

double lambdaFor(std::span<const BasisAnalysis> analyses, const LayoutTarget& target) {
    return target.bytes ? lambdaForBytes(analyses, *target.bytes) : lambdaForError(analyses, target.error);
}

} // namespace

EncodedCluster encodeBases(const ClusterMatrix& matrix, const BasisAnalysis& analysis, const BasisCut& cut,
                           std::span<const BasisKind> kinds, std::span<const float> spectrum) {
    EncodedCluster encoded;
    encoded.error = matrix.energy.sum();
    BasisCluster& cluster = encoded.cluster;
    cluster.components = cut.components;
    cluster.counts = cut.counts;
    if (cut.components == 0) return encoded;

    Eigen::VectorXf weights(Eigen::Index(cut.columns.size()));
    for (size_t i = 0; i < cut.columns.size(); i++) {
        cluster.indices.push_back(matrix.columns[cut.columns[i]]);
        weights[Eigen::Index(i)] = spectrum[cluster.indices.back()];
    }
    const Eigen::Index vectors =
        std::max<Eigen::Index>(1, Eigen::Index(cut.components) - kFirstComponents + 1);
    const Eigen::MatrixXf values = matrix.values(Eigen::all, cut.columns);
    QuantizedBasis basis =
        quantizeBasis(analysis.vectors(cut.columns, Eigen::seqN(0, vectors)), weights, cut.components);
    cluster.basis = std::move(basis.values);

    const Eigen::MatrixXf gram = basis.vectors.transpose() * basis.vectors;
    for (size_t kind = 0; kind < kinds.size(); kind++) {
        const uint32_t count = cut.counts[kind];
        if (count == 0) continue;
        const Eigen::Index own = std::max<Eigen::Index>(1, Eigen::Index(count) - kFirstComponents + 1);
        const Eigen::MatrixXf side =
            values.middleRows(Eigen::Index(kind) * matrix.vertices, matrix.vertices) *
            basis.vectors.leftCols(own);
        Eigen::MatrixXf metric = gram.topLeftCorner(own, own);
        metric.diagonal().array() += 1e-6f * metric.trace() / float(own);
        const Eigen::MatrixXf fitted = metric.ldlt().solve(side.transpose()).transpose();
        Eigen::MatrixXf lost = fitted;

        const size_t start = cluster.weights.size();
        cluster.weights.resize(start + size_t(count) * matrix.vertices);
        const float norm = matrix.norm / glm::length(kinds[kind].color);
        const auto steps = [&](uint32_t component) {
            return std::span(cluster.weights).subspan(start + component);
        };
        const auto scale = [&](uint32_t component, float step) {
            cluster.scales.push_back(step * basis.steps[component] * norm);
        };
        const float first = quantize(lost.col(0), steps(0), count);
        scale(0, first);
        for (uint32_t component = 1; component < count; component++) {
            if (component == 1) {
                for (uint32_t vertex = 0; vertex < matrix.vertices; vertex++)
                    steps(1)[size_t(vertex) * count] = steps(0)[size_t(vertex) * count];
                scale(1, first);
            } else
                scale(component,
                      quantize(lost.col(component < kFirstComponents ? 0 : component - kFirstComponents + 1),
                               steps(component), count));
        }
        const Eigen::MatrixXf kept = fitted - lost;
        encoded.error += double((kept * gram.topLeftCorner(own, own)).cwiseProduct(kept).sum()) -
                         2 * double(kept.cwiseProduct(side).sum());
    }
    encoded.error = std::max(0.0, encoded.error);
    return encoded;
}

void prepareLayout(BasisTransport& layout, const FactoredBrdf& brdf, bool isBounced) {
    layout.kinds = basisKinds(brdf, isBounced);
}

EncodedBlock encodeBlock(const BasisTransport& layout, const SparseTransport& rows,
                         const BlockCoding& coding) {
    const std::vector<float> spectrum = lightSpectrum(coding.faceSize);
    const ClusterMatrix matrix = clusterMatrix(rows, 0, rows.vertices, layout.kinds, spectrum, coding.norm);
    const BasisAnalysis analysis = analyze(matrix);
    const EncodedCluster encoded =
        encodeBases(matrix, analysis, cutFor(analysis, coding.lambda), layout.kinds, spectrum);
    checkCluster(encoded.cluster, rows.vertices, layout.kinds.size(), uint32_t(spectrum.size()),
                 coding.where);
    return {encodeBasisCluster(encoded.cluster, coding.run, rows.vertices), encoded.error};
}

double findLambda(const BasisTransport&, std::span<const SetSample> samples, int faceSize,
                  const LayoutTarget& target) {
    struct Place {
        const SetSample* sample;
        const SparseTransport* rows;
        uint32_t first;
    };
    std::vector<Place> places;
    for (const SetSample& sample : samples)
        for (const SparseTransport* rows : sample.blocks)
            for (uint32_t first = 0; first < rows->vertices; first += kBasisVertices)
                places.push_back({&sample, rows, first});
    const std::vector<float> spectrum = lightSpectrum(faceSize);
    std::vector<BasisAnalysis> analyses(places.size());
    tbb::parallel_for(size_t(0), places.size(), [&](size_t i) {
        const auto& [sample, rows, first] = places[i];
        const uint32_t count = std::min(kBasisVertices, rows->vertices - first);
        analyses[i] = analyze(clusterMatrix(
            *rows, first, count, basisKinds(sample->set->brdf, sample->isBounced), spectrum, sample->norm));
        analyses[i].weight = double(sample->vertices) / double(sample->sampledVertices());
    });
    return lambdaFor(analyses, target);
}

double convertRows(const BasisTransport&, const RowSource& source, const LayoutTarget& target,
                   ConversionPasses& passes) {
    std::vector<BasisTransport> made;
    for (const MaterialSet* set : source.sets) {
        const SparseTransport& rows = rowsOf(set->transport);
        made.push_back({rows.vertices, rows.terms, basisKinds(set->brdf, source.isBounced), {}});
        made.back().clusters.resize(made.back().clusterCount());
    }
    const std::vector<SetPlace> places = placesOf(source.sets, kBasisVertices);
    const auto matrixOf = [&](const SetPlace& place) {
        return clusterMatrix(rowsOf(source.sets[place.set]->transport), place.first, place.count,
                             made[place.set].kinds, source.spectrum, source.norms[place.set]);
    };

    // Two passes over the rows (kConversionPasses): analysis of all clusters, then encoding.
    std::vector<BasisAnalysis> analyses(places.size());
    passes.run(places, [&](size_t i) { analyses[i] = analyze(matrixOf(places[i])); });
    const double lambda = lambdaFor(analyses, target);
    std::vector<double> errors(places.size());
    passes.run(places, [&](size_t i) {
        const SetPlace& place = places[i];
        EncodedCluster encoded = encodeBases(matrixOf(place), analyses[i], cutFor(analyses[i], lambda),
                                             made[place.set].kinds, source.spectrum);
        made[place.set].clusters[place.first / kBasisVertices] = std::move(encoded.cluster);
        errors[i] = encoded.error;
        analyses[i] = {};
    });
    for (size_t number = 0; number < made.size(); number++)
        source.sets[number]->transport = std::move(made[number]);
    double error = 0;
    for (const double own : errors) error += own;
    return error;
}

} // namespace relume
