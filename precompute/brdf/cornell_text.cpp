#include "precompute/brdf/cornell_text.h"

#include "engine/base/error.h"
#include "engine/math/vector.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/core.h>

namespace relume {

namespace {

constexpr size_t kMaxWavelengths = 1000, kMaxSamples = 20'000, kMinSamples = 16;
constexpr float kMaxCornellValue = 1e6f; // sr⁻¹, far above any surface

class Reader {
  public:
    Reader(std::string_view text, const std::string& name) : mText(text), mName(name) {}

    CornellText read() {
        size_t wavelengthCount = 0;
        while (nextLine()) {
            if (mNumbers.empty()) continue;
            if (wavelengthCount == 0)
                wavelengthCount = readCount();
            else if (mResult.wavelengths.size() < wavelengthCount)
                readWavelengths(wavelengthCount);
            else
                readSample(wavelengthCount);
        }
        if (mResult.samples.size() < kMinSamples)
            throw Error(
                fmt::format("{}: {} samples; expected a Cornell BRDF file with {} or more: the number of "
                            "wavelengths, the wavelengths, then a line per sample",
                            mName, mResult.samples.size(), kMinSamples));
        return std::move(mResult);
    }

  private:
    template <typename... Args>
    [[noreturn]] void fail(fmt::format_string<Args...> text, Args&&... args) const {
        throw Error(
            fmt::format("{}, line {}: {}", mName, mLine, fmt::format(text, std::forward<Args>(args)...)));
    }

    // Splits the next line into numbers. Returns false at the end.
    bool nextLine() {
        if (mText.empty()) return false;
        mLine++;
        mNumbers.clear();
        const size_t end = mText.find('\n');
        std::string_view line = mText.substr(0, end);
        mText.remove_prefix(end == std::string_view::npos ? mText.size() : end + 1);
        line = line.substr(0, line.find('#'));
        for (size_t start; (start = line.find_first_not_of(" \t\r")) != std::string_view::npos;) {
            line.remove_prefix(start);
            const std::string_view token = line.substr(0, line.find_first_of(" \t\r"));
            float number = 0;
            const auto [last, error] = std::from_chars(token.data(), token.data() + token.size(), number);
            if (error != std::errc() || last != token.data() + token.size() || !std::isfinite(number))
                fail("expected a finite number, found \"{}\"", printable(token));
            mNumbers.push_back(number);
            line.remove_prefix(token.size());
        }
        return true;
    }

    static std::string printable(std::string_view token) {
        std::string text(token.substr(0, 40));
        for (char& letter : text)
            if (letter < ' ' || letter > '~') letter = '?';
        return text;
    }

    size_t readCount() const {
        const float count = mNumbers.front();
        if (mNumbers.size() != 1 || count != std::floor(count) || count < 2 || count > float(kMaxWavelengths))
            fail("expected the number of wavelengths alone, 2 to {}", kMaxWavelengths);
        return size_t(count);
    }

    void readWavelengths(size_t count) {
        std::vector<float>& wavelengths = mResult.wavelengths;
        for (float number : mNumbers) {
            if (number < 200 || number > 2000 || (!wavelengths.empty() && number <= wavelengths.back()))
                fail("expected wavelengths from 200 to 2000 nm, each above the one before, found {}", number);
            wavelengths.push_back(number);
        }
        if (wavelengths.size() > count) fail("more wavelengths than the {} announced", count);
        if (wavelengths.size() == count && (wavelengths.front() > 450 || wavelengths.back() < 620))
            fail("the wavelengths must reach from 450 nm or below to 620 nm or above, to make a color");
    }

    void readSample(size_t wavelengthCount) {
        if (mNumbers.size() != 4 + wavelengthCount)
            fail("expected four angles and {} values, found {} numbers", wavelengthCount, mNumbers.size());
        if (mResult.samples.size() == kMaxSamples) fail("more than {} samples", kMaxSamples);
        CornellSample sample;
        std::copy_n(mNumbers.begin(), 4, sample.angles.begin());
        for (size_t theta : {0u, 2u})
            if (sample.angles[theta] < 0 || sample.angles[theta] >= kPi / 2)
                fail("expected an angle from the normal of 0 to less than pi/2, found {}",
                     sample.angles[theta]);
        for (size_t phi : {1u, 3u})
            if (std::abs(sample.angles[phi]) > 100)
                fail("expected an azimuth in radians, found {}", sample.angles[phi]);
        sample.values.assign(mNumbers.begin() + 4, mNumbers.end());
        for (float value : sample.values)
            if (std::abs(value) > kMaxCornellValue)
                fail("expected values up to {} sr^-1, found {}", kMaxCornellValue, value);
        mResult.samples.push_back(std::move(sample));
    }

    std::string_view mText;
    const std::string& mName;
    size_t mLine = 0;
    std::vector<float> mNumbers; // of the current line
    CornellText mResult;
};

} // namespace

CornellText readCornellText(std::string_view text, const std::string& name) {
    return Reader(text, name).read();
}

} // namespace relume
