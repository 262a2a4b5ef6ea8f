#include "precompute/bake/bake_estimate.h"

namespace relume {

namespace {

// Vertices of a part to be measured before they represent the rest of it.
constexpr uint64_t kMeasuredVertices = 256;

} // namespace

BakeEstimate::BakeEstimate(std::vector<Part> parts) {
    for (const Part& part : parts) mWork.push_back({part});
}

void BakeEstimate::add(size_t part, uint64_t vertices, double seconds) {
    mWork[part].done += vertices;
    mWork[part].seconds += seconds;
}

double BakeEstimate::cost(const Work& work, double correction) const {
    const bool measured = work.done >= kMeasuredVertices ||
                          (work.done > 0 && work.part.doneBefore + work.done == work.part.vertices);
    return measured ? work.seconds / double(work.done) : work.part.probedSeconds * correction;
}

BakeStatus BakeEstimate::status() const {
    double seconds = 0, probed = 0;
    uint64_t ownDone = 0;
    for (const Work& work : mWork) {
        seconds += work.seconds;
        probed += double(work.done) * work.part.probedSeconds;
        ownDone += work.done;
    }
    const double correction = probed > 0 ? seconds / probed : 1;
    BakeStatus status;
    double spent = 0, total = 0; // seconds, as if this run had done it all
    for (const Work& work : mWork) {
        const uint64_t done = work.part.doneBefore + work.done;
        const double perVertex = cost(work, correction);
        status.vertices += work.part.vertices;
        status.done += done;
        spent += perVertex * double(done);
        total += perVertex * double(work.part.vertices);
    }
    status.fraction = status.done == status.vertices ? 1 : total > 0 ? spent / total : 0;
    status.verticesPerSecond = seconds > 0 ? double(ownDone) / seconds : 0;
    status.secondsLeft = ownDone > 0 ? total - spent : 0;
    return status;
}

} // namespace relume
