#include "precompute/layout/bases/basis_analysis.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <random>
#include <tbb/parallel_for.h>

namespace relume {

namespace {

constexpr uint32_t kStep = 4; // components are read four at a time

// Returns the most vectors computed, more than any budget with fast relighting needs. With few kinds a vector
// is cheap, since it has few weights.
Eigen::Index mostVectors(size_t kinds) {
    constexpr size_t kMost = kMostBasisComponents - kFirstComponents + 1;
    return Eigen::Index(kinds <= kFewKinds ? kMost : std::min(64 + 8 * kinds, kMost));
}

// Returns the vector of a component, or -1 if the component only refines the first.
Eigen::Index vectorOf(uint32_t component) {
    if (component == 0) return 0;
    return component < kFirstComponents ? -1 : Eigen::Index(component - kFirstComponents + 1);
}

constexpr Eigen::Index kSpare = 16; // additional vectors with which the wanted ones converge
constexpr int kSubspaceIterations = 4;
constexpr float kLeastSingularValue = 1e-7f; // relative to the largest

Eigen::MatrixXf orthonormal(const Eigen::MatrixXf& vectors) {
    return Eigen::HouseholderQR<Eigen::MatrixXf>(vectors).householderQ() *
           Eigen::MatrixXf::Identity(vectors.rows(), vectors.cols());
}

struct LeadingEigenvectors {
    Eigen::VectorXf values;  // descending
    Eigen::MatrixXf vectors; // columns, orthonormal
};

// Returns up to `count` of the largest eigenpairs of a positive semidefinite matrix, given its lower
// triangle, without those below rounding. Uses subspace iteration if that is cheaper; the energy captured is
// then within about 1 % of the optimum, relative to what is left.
LeadingEigenvectors leadingEigenvectors(const Eigen::MatrixXf& lower, Eigen::Index count) {
    const Eigen::Index size = lower.rows();
    Eigen::MatrixXf subspace;
    Eigen::MatrixXf reduced = lower;
    const bool isPartial = 3 * (count + kSpare) < size;
    if (isPartial) {
        const auto matrix = lower.selfadjointView<Eigen::Lower>();
        std::mt19937 random; // the same start each time
        subspace =
            Eigen::MatrixXf::NullaryExpr(size, count + kSpare, [&] { return random() & 1 ? 1.0f : -1.0f; });
        for (int i = 0; i < kSubspaceIterations; i++) subspace = orthonormal(matrix * subspace);
        reduced = subspace.transpose() * (matrix * subspace);
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXf> solver(reduced);
    LeadingEigenvectors leading;
    leading.values = solver.eigenvalues().reverse();
    Eigen::Index kept = 0;
    while (kept < std::min(count, leading.values.size()) &&
           leading.values[kept] > kLeastSingularValue * leading.values[0])
        kept++;
    leading.values.conservativeResize(kept);
    leading.vectors = solver.eigenvectors().rightCols(kept).rowwise().reverse();
    if (isPartial) leading.vectors = subspace * leading.vectors;
    return leading;
}

// The rows of one kind, without the columns that are empty in them. Where light bounces, kinds other than
// gray hold bounced light alone, which has a third of the columns.
struct KindRows {
    std::vector<Eigen::Index> columns; // those that remain, ascending
    Eigen::MatrixXf values;
};

KindRows rowsOfKind(const ClusterMatrix& matrix, Eigen::Index kind) {
    const auto own = matrix.values.middleRows(kind * matrix.vertices, matrix.vertices);
    KindRows rows;
    for (Eigen::Index column = 0; column < own.cols(); column++)
        if ((own.col(column).array() != 0).any()) rows.columns.push_back(column);
    rows.values = own(Eigen::all, rows.columns);
    return rows;
}

// Adds valuesᵀ · values to the lower triangle of `gram`.
void addGram(const KindRows& rows, Eigen::MatrixXf& gram) {
    const auto size = Eigen::Index(rows.columns.size());
    Eigen::MatrixXf own = Eigen::MatrixXf::Zero(size, size);
    own.selfadjointView<Eigen::Lower>().rankUpdate(rows.values.transpose());
    for (Eigen::Index column = 0; column < size; column++)
        for (Eigen::Index row = column; row < size; row++)
            gram(rows.columns[size_t(row)], rows.columns[size_t(column)]) += own(row, column);
}

// Neighboring lambdas.
struct Lambdas {
    double low, high;
};

// Returns the lambdas between which `isHigh` becomes true, by bisection of a range beyond which nothing
// changes.
template <typename IsHigh>
Lambdas lambdasAround(const IsHigh& isHigh) {
    double low = -80, high = 20;
    for (int i = 0; i < 36; i++) {
        const double middle = 0.5 * (low + high);
        (isHigh(std::exp2(middle)) ? high : low) = middle;
    }
    return {std::exp2(low), std::exp2(high)};
}

} // namespace

uint32_t BasisAnalysis::components() const {
    return vectors.cols() == 0 ? 0 : uint32_t(vectors.cols()) + kFirstComponents - 1;
}

BasisAnalysis analyze(const ClusterMatrix& matrix) {
    const Eigen::MatrixXf& values = matrix.values;
    BasisAnalysis analysis;
    analysis.vertices = matrix.vertices;
    analysis.importance = matrix.importance;
    analysis.columns = matrix.columns;
    analysis.energy = matrix.energy;
    analysis.vectorEnergy.resize(Eigen::Index(matrix.kinds()), 0);
    if (values.size() == 0) return analysis; // there are no rows to point to
    std::vector<KindRows> kinds;
    for (Eigen::Index kind = 0; kind < Eigen::Index(matrix.kinds()); kind++)
        kinds.push_back(rowsOfKind(matrix, kind));
    const bool isWide = values.rows() < values.cols();
    const Eigen::Index size = std::min(values.rows(), values.cols());
    Eigen::MatrixXf gram = Eigen::MatrixXf::Zero(size, size);
    if (isWide)
        gram.selfadjointView<Eigen::Lower>().rankUpdate(values);
    else
        for (const KindRows& rows : kinds) addGram(rows, gram);
    const LeadingEigenvectors leading =
        leadingEigenvectors(gram, std::min(size, mostVectors(matrix.kinds())));
    analysis.vectors = leading.vectors;
    if (isWide)
        analysis.vectors =
            values.transpose() * leading.vectors * leading.values.cwiseSqrt().cwiseInverse().asDiagonal();
    analysis.vectorEnergy.resize(Eigen::Index(matrix.kinds()), analysis.vectors.cols());
    for (size_t kind = 0; kind < kinds.size(); kind++) {
        const Eigen::MatrixXf own = analysis.vectors(kinds[kind].columns, Eigen::all);
        analysis.vectorEnergy.row(Eigen::Index(kind)) =
            (kinds[kind].values * own).colwise().squaredNorm().cast<double>();
    }
    return analysis;
}

BasisCut cutFor(const BasisAnalysis& analysis, double lambda) {
    const Eigen::Index kinds = analysis.energy.size(), columns = Eigen::Index(analysis.columns.size());
    const uint32_t components = analysis.components();
    lambda /= analysis.importance;
    const double weightBytes = double(analysis.vertices) + sizeof(float); // of one component of one kind
    const double countBytes = sizeof(uint16_t) * double(kinds);
    const auto columnBytes = [](uint32_t count) { return double(count + sizeof(uint16_t)); };

    BasisCut best;
    best.counts.assign(size_t(kinds), 0);
    best.error = analysis.energy.sum();
    best.bytes = countBytes;
    double least = best.error; // error + lambda · bytes, without countBytes

    std::vector<uint16_t> counts(size_t(kinds), 0);
    Eigen::VectorXd tail = analysis.energy,
                    cost = tail; // per kind: error with `count` components; least error + lambda · bytes
    Eigen::VectorXd gain = Eigen::VectorXd::Zero(columns); // reduction of the error by a column
    std::vector<double> bestGain;
    for (uint32_t count = 0; count < components;) {
        const uint32_t last = count, next = std::min(count + kStep, components);
        bool hasJumped = false; // a kind starts to use components that did not pay off before
        double error = 0, weights = 0;
        for (uint32_t i = last; i < next; i++)
            if (const Eigen::Index vector = vectorOf(i); vector >= 0)
                tail -= analysis.vectorEnergy.col(vector);
        count = next;
        for (Eigen::Index kind = 0; kind < kinds; kind++) {
            const double paid = tail[kind] + lambda * weightBytes * count;
            if (paid < cost[kind]) {
                hasJumped |= counts[size_t(kind)] != last;
                cost[kind] = paid;
                counts[size_t(kind)] = uint16_t(count);
            }
            weights += counts[size_t(kind)];
        }
        if (*std::ranges::max_element(counts) < count) continue;
        if (hasJumped) gain.setZero();
        for (uint32_t i = hasJumped ? 0 : last; i < count; i++) {
            const Eigen::Index vector = vectorOf(i);
            if (vector < 0) continue;
            double energy = 0;
            for (Eigen::Index kind = 0; kind < kinds; kind++)
                if (counts[size_t(kind)] > i) energy += analysis.vectorEnergy(kind, vector);
            gain += energy * analysis.vectors.col(vector).cast<double>().cwiseAbs2();
        }
        double taken = 0;
        size_t kept = 0;
        for (Eigen::Index column = 0; column < columns; column++)
            if (gain[column] > lambda * columnBytes(count)) taken += gain[column], kept++;
        error = std::max(0.0, analysis.energy.sum() - taken);
        const double bytes = weights * weightBytes + double(kept) * columnBytes(count);
        if (error + lambda * bytes < least) {
            least = error + lambda * bytes;
            best.components = count;
            best.counts = counts;
            best.bytes = bytes + countBytes;
            best.error = error;
            bestGain.assign(gain.begin(), gain.end());
        }
    }
    for (size_t column = 0; column < bestGain.size(); column++)
        if (bestGain[column] > lambda * columnBytes(best.components))
            best.columns.push_back(uint32_t(column));
    return best;
}

CutTotals totalsAt(std::span<const BasisAnalysis> clusters, double lambda) {
    std::vector<CutTotals> each(clusters.size());
    tbb::parallel_for(size_t(0), clusters.size(), [&](size_t i) {
        const BasisCut cut = cutFor(clusters[i], lambda);
        each[i] = {clusters[i].weight * cut.bytes, clusters[i].weight * cut.error};
    });
    CutTotals sum;
    for (const CutTotals& one : each) sum.bytes += one.bytes, sum.error += one.error;
    return sum;
}

double lambdaForBytes(std::span<const BasisAnalysis> clusters, double bytes) {
    return lambdasAround([&](double lambda) { return totalsAt(clusters, lambda).bytes <= bytes; }).high;
}

double lambdaForError(std::span<const BasisAnalysis> clusters, double error) {
    const double least = totalsAt(clusters, 0).error, allowed = least > error ? least + 0.1 * error : error;
    return lambdasAround([&](double lambda) { return totalsAt(clusters, lambda).error > allowed; }).low;
}

} // namespace relume
