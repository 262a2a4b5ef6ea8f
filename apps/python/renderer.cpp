// Bindings of rendering and relighting.
#include "apps/python/checks.h"
#include "apps/python/module.h"
#include "engine/base/error.h"
#include "engine/import/image_file.h"
#include "engine/render/background_pass.h"
#include "engine/render/compare.h"
#include "engine/render/tone_map.h"
#include "engine/render/view_pass.h"

#include <limits>
#include <mutex>

namespace relume::python {

namespace {

Camera cameraOf(const Asset& asset, float azimuth, float elevation, float distance, float fov, float aspect) {
    expectWithin("azimuth", azimuth, -kLargestNumber, kLargestNumber);
    expectWithin("elevation", elevation, -kLargestNumber, kLargestNumber);
    expectWithin("distance", distance, 1e-6f, kLargestNumber);
    expectWithin("fov", fov, 1.0f, 170.0f);
    expectWithin("aspect", aspect, 1e-4f, 1e4f);
    return checked(orbitCamera(objectBounds(asset), glm::radians(azimuth), glm::radians(elevation), distance,
                               glm::radians(fov), aspect));
}

// Draws and relights an asset. Several threads may call it.
class Renderer {
  public:
    Renderer(std::shared_ptr<const vk::Device> on, std::shared_ptr<const Asset> asset,
             std::pair<int, int> size, int samples, bool residual)
        : mDevice(std::move(on)), mAsset(std::move(asset)), mLight(*mDevice, mAsset->faceSize),
          mRelighter(*mDevice, *mAsset, {.residual = residual}),
          mView(*mDevice, *mAsset, {.width = size.first, .height = size.second, .samples = samples}),
          mAppearance(defaultAppearance(*mAsset)), mSize(size) {}

    void bind(const std::map<std::string, float>& blend) {
        std::vector<WeightedMaterial> materials;
        float sum = 0;
        for (const auto& [name, weight] : blend) {
            expectWithin("weight", weight, 0.0f, kLargestNumber);
            materials.push_back({name, weight});
            sum += weight;
        }
        if (sum == 0) throw UsageError("materials: expected at least one weight above 0");
        const std::lock_guard lock(mMutex);
        Appearance bound = mAppearance; // a copy: a failure leaves mAppearance as it is
        relume::bindMaterials(bound, *mAsset, materials);
        mView.setAppearance(bound);
        mAppearance = std::move(bound);
    }

    void setSelection(std::optional<int> threshold, std::optional<int> coefficients) {
        if (threshold) expectWithin("threshold", *threshold, 0, kLightMaximum);
        if (coefficients) expectWithin("coefficients", *coefficients, 1, int(kMaximumLightEntries));
        const std::lock_guard lock(mMutex);
        mSelection = {};
        if (threshold || coefficients) mSelection = {threshold, coefficients.value_or(kDefaultLightCount)};
    }

    void setTerms(std::optional<int> terms) {
        if (terms) expectWithin("terms", *terms, 1, kMostTerms);
        const std::lock_guard lock(mMutex);
        mView.setTerms(terms.value_or(0));
    }

    Image render(const Light& light, const std::optional<Camera>& camera, bool showsLight) {
        const std::lock_guard lock(mMutex);
        const Camera eye = camera.value_or(defaultCamera(objectBounds(*mAsset), glm::radians(35.0f),
                                                         float(mSize.first) / float(mSize.second)));
        if (showsLight) {
            if (!mBackground) mBackground.emplace(*mDevice);
            mBackground->setLight(light, 0);
        }
        mView.setGroundFade(makeGroundFade(*mAsset, showsLight ? GroundStyle::Shadow : GroundStyle::Whole));
        mLight.setLight(light);
        vk::Commands commands(*mDevice, "render");
        commands.begin();
        mLight.record(commands, 0, mSelection);
        mRelighter.record(commands, mLight, mAppearance);
        mView.record(commands, eye, mRelighter);
        if (showsLight) mBackground->record(commands, mView.image(), eye, 0);
        commands.submitAndWait();
        return showsLight ? mBackground->read() : mView.read();
    }

    // Returns each part's tuples, vertex after vertex, and its K.
    std::vector<std::pair<std::vector<vec3>, size_t>> relight(const Light& light) {
        const std::lock_guard lock(mMutex);
        mLight.setLight(light);
        vk::Commands commands(*mDevice, "relight");
        commands.begin();
        mLight.record(commands, 0, mSelection);
        mRelighter.record(commands, mLight, mAppearance);
        commands.submitAndWait();
        std::vector<std::pair<std::vector<vec3>, size_t>> tuples;
        for (size_t part = 0; part < mAsset->parts.size(); part++) {
            const size_t set = mAppearance[part].set;
            tuples.emplace_back(mRelighter.readTuples(part, set),
                                size_t(mAsset->parts[part].sets[set].brdf.terms));
        }
        return tuples;
    }

  private:
    std::mutex mMutex;
    std::shared_ptr<const vk::Device> mDevice;
    std::shared_ptr<const Asset> mAsset;
    LightPass mLight;
    Relighter mRelighter;
    ViewPass mView;
    std::optional<BackgroundPass> mBackground; // made when first needed
    Appearance mAppearance;
    LightSelection mSelection;
    std::pair<int, int> mSize;
};

py::list relight(Renderer& renderer, const Light& light) {
    std::vector<std::pair<std::vector<vec3>, size_t>> tuples;
    {
        const py::gil_scoped_release unlocked;
        tuples = renderer.relight(light);
    }
    py::list parts;
    for (auto& [values, terms] : tuples) {
        const auto vertices = py::ssize_t(values.size() / terms);
        parts.append(arrayOf(std::move(values), {vertices, py::ssize_t(terms)}));
    }
    return parts;
}

// Writes an image as `relume render` does: linear to .exr, tone-mapped to .png. Returns the exposure of the
// latter.
float save(const std::filesystem::path& path, const Array<float>& array, std::optional<float> exposure,
           const std::string& tone) {
    Image image = imageOf(array, "image");
    const std::optional<ToneCurve> curve = toneCurveFromName(tone);
    if (!curve) throw UsageError("tone: expected none, aces or agx");
    if (exposure) expectWithin("exposure", *exposure, -100.0f, 100.0f);
    const py::gil_scoped_release unlocked;
    if (path.extension() == ".exr") {
        writeExr(path, image);
        return 0;
    }
    if (path.extension() != ".png") throw UsageError("save: expected a name ending in .exr or .png");
    for (const vec4& pixel : image.pixels)
        if (!glm::all(glm::lessThan(glm::abs(pixel), vec4(std::numeric_limits<float>::infinity()))))
            throw UsageError("image: expected pixels that are finite");
    const float stops = exposure ? *exposure : autoExposure(image);
    for (vec4& pixel : image.pixels) // alpha of .png is not premultiplied
        if (pixel.w > 0 && pixel.w < 1) pixel = vec4(vec3(pixel) / pixel.w, pixel.w);
    writePng(path, toneMap(image, *curve, stops));
    return stops;
}

py::dict compare(const Array<float>& image, const Array<float>& reference) {
    const ImageDifference difference =
        compareImages(imageOf(image, "image"), imageOf(reference, "reference"));
    py::dict result;
    result["relative_rmse"] = difference.relativeRmse;
    result["psnr"] = difference.psnr;
    result["max_difference"] = difference.maxDifference;
    result["flip"] = difference.flip;
    return result;
}

} // namespace

void addRenderer(py::module_& module) {
    py::class_<Renderer>(module, "Renderer")
        .def(py::init(
            [](const std::shared_ptr<Asset>& asset, std::pair<int, int> size, int samples, bool residual) {
                expectBaked(asset);
                expectSize(size);
                expectSamples(samples);
                std::shared_ptr<const vk::Device> on = device();
                const py::gil_scoped_release unlocked;
                return std::make_unique<Renderer>(std::move(on), asset, size, samples, residual);
            }))
        .def("bind", &Renderer::bind, py::call_guard<py::gil_scoped_release>())
        .def("select_terms", &Renderer::setTerms, py::call_guard<py::gil_scoped_release>())
        .def("select_light", &Renderer::setSelection, py::call_guard<py::gil_scoped_release>())
        .def(
            "render",
            [](Renderer& renderer, const Light& light, const std::optional<Camera>& camera, bool showsLight) {
                Image image;
                {
                    const py::gil_scoped_release unlocked;
                    image = renderer.render(light, camera, showsLight);
                }
                return arrayOf(std::move(image));
            })
        .def("relight", relight, py::arg("light"));
    module.def("_orbit", cameraOf);
    module.def("_save", save);
    module.def(
        "load_image", [](const std::filesystem::path& path) { return arrayOf(readImage(path).image); },
        py::arg("path"));
    module.def("compare", compare, py::arg("image"), py::arg("reference"));
}

} // namespace relume::python
