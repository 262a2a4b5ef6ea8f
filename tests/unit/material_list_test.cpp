// Tests lists of materials: sets, names, files.
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "precompute/brdf/material_factory.h"
#include "precompute/brdf/material_list.h"
#include "tests/support/temporary_folder.h"

#include <cmath>
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace relume;
using namespace relume::test;

namespace {

std::vector<std::vector<std::string>> namesOf(const MaterialSets& sets) {
    std::vector<std::vector<std::string>> names;
    for (const auto& set : sets) {
        names.emplace_back();
        for (const NamedMaterial& material : set) names.back().push_back(material.name);
    }
    return names;
}

using Names = std::vector<std::vector<std::string>>;

MaterialFactory smallFactory(int terms) {
    return {FactorizationOptions{.terms = terms}, 12, DiskMapping::EqualArea};
}

} // namespace

TEST_CASE("material list: one material, a set, and sets baked separately") {
    CHECK(namesOf(readMaterials("clay")) == Names{{"clay"}});
    CHECK(namesOf(readMaterials(R"({"model": "plastic"})")) == Names{{"plastic"}});
    CHECK(namesOf(readMaterials(R"({"set": ["clay", {"name": "coat", "model": "plastic"}, "clay"]})")) ==
          Names{{"clay", "coat", "clay 2"}});
    CHECK(namesOf(readMaterials(R"({"separate": ["clay", {"set": ["skin", "gold"]}]})")) ==
          Names{{"clay"}, {"skin", "gold"}});
}

TEST_CASE("material list: a file may hold any of these, and paths in it start at its folder") {
    const TemporaryFolder folder;
    writeFileAtomically(folder.path() / "inner.json", R"({"model": "phong"})");
    writeFileAtomically(folder.path() / "list.json", R"({"set": ["clay", "inner.json"]})");
    const MaterialSets sets = readMaterials("list.json", folder.path());
    CHECK(namesOf(sets) == Names{{"clay", "inner"}});
    CHECK(sets[0][1].brdf->describe()["model"] == "phong");
}

TEST_CASE("material list: a file that is no object is refused, even one that names itself") {
    const TemporaryFolder folder;
    for (const char* content : {"loop.json", "\"loop.json\"", "gold", "[\"gold\"]", ""}) {
        folder.write("loop.json", content);
        CHECK_THROWS_WITH_AS(readMaterials("loop.json", folder.path()), doctest::Contains("loop.json: "),
                             Error);
    }
    folder.write("set.json", R"({"set": ["clay", {"name": "coat", "model": "plastic"}]})");
    CHECK(namesOf(readMaterials(R"({"separate": ["set.json", "gold"]})", folder.path())) ==
          Names{{"clay", "coat"}, {"gold"}});
    folder.write("named.json", R"({"name": "mine", "model": "plastic"})");
    CHECK(namesOf(readMaterials("named.json", folder.path())) == Names{{"mine"}});
    CHECK(makeBrdf("named.json", folder.path())->describe()["model"] == "plastic");
}

TEST_CASE("material list: what makes no sense is refused, and says why") {
    const auto refuses = [](const std::string& text, const char* why) {
        CHECK_THROWS_WITH_AS(readMaterials(text), doctest::Contains(why), Error);
    };
    refuses(R"({"set": []})", "an empty one");
    refuses(R"({"set": "gold"})", "found string");
    refuses(R"({"set": ["clay"], "name": "x"})", "nothing else");
    refuses(R"({"set": [7]})", "expected a name or an object");
    refuses(R"({"set": [{"set": ["clay"]}]})", "several materials");
    refuses(R"({"separate": [{"separate": ["clay"]}]})", "several materials");
    refuses(R"({"set": ["cly"]})", "did you mean \"clay\"");
    refuses(R"({"set": [{"name": "", "model": "plastic"}]})", "\"name\"");
    refuses(R"({"set": ["clay", {"name": "clay", "model": "plastic"}]})", "two materials are called");
    std::string many = R"({"set": [)";
    for (int i = 0; i < 17; i++) many += std::string(i ? "," : "") + "\"clay\"";
    refuses(many + "]}", "more than 16");
    refuses(R"({"set": ["clay","clay","clay","clay","clay","clay","clay","clay","clay"]})", "can hold 8");
    refuses(R"({"set": [{"name": "a\u0000b", "model": "plastic"}]})", "control characters");
    const TemporaryFolder folder; // a material is named after its file
    folder.write("a\tb.json", R"({"model": "plastic"})");
    CHECK_THROWS_WITH_AS(readMaterials("a\tb.json", folder.path()), doctest::Contains("control characters"),
                         Error);
}

TEST_CASE("material factory: members of a set share light maps, each has its view maps") {
    MaterialFactory factory = smallFactory(32);
    const auto sets = factory.make(R"({"set": ["clay", "red-plastic"]})", {}, false);
    REQUIRE(sets.size() == 1);
    CHECK(sets[0].brdf.layers == 2);
    CHECK(sets[0].materials[1].layer == 1);
    for (const AssetMaterial& material : sets[0].materials) {
        const auto brdf = makeBrdf(material.description);
        const vec3 in = glm::normalize(vec3(0.3f, 0.1f, 1)), out = glm::normalize(vec3(-0.2f, 0.2f, 1));
        const vec3 exact = brdf->evaluate(in, out), found = evaluate(sets[0].brdf, in, out, material.layer);
        CHECK(glm::length(found - exact) < 0.1f * glm::length(exact));
    }
}

TEST_CASE("material factory: equal materials are factored once, under all of their names") {
    MaterialFactory factory = smallFactory(32);
    for (int i = 0; i < 21; i++) {
        const std::string name = "coat " + std::to_string(i);
        const auto sets = factory.make(R"({"model": "plastic", "name": ")" + name + "\"}", {}, false);
        CHECK(sets[0].materials[0].name == name);
        CHECK(sets[0].brdf.terms == 32);
    }
    CHECK(factory.factored() == 1);
    factory.make("clay", {}, false);
    CHECK(factory.factored() == 2);
}

TEST_CASE("material factory: a texture splits what has a base, and only that") {
    MaterialFactory factory = smallFactory(32);
    const auto sets = factory.make(R"({"set": ["red-plastic", "gold"]})", {}, true);
    REQUIRE(sets[0].materials.size() == 2);
    CHECK(sets[0].materials[0].hasBase);
    CHECK_FALSE(sets[0].materials[1].hasBase); // a conductor has none
    CHECK(sets[0].materials[1].layer == 2);
    CHECK(sets[0].brdf.layers == 3);
    const auto brdf = makeBrdf("red-plastic");
    const vec3 in = glm::normalize(vec3(0.3f, 0.1f, 1)), out = glm::normalize(vec3(-0.2f, 0.2f, 1));
    const vec3 base = evaluate(sets[0].brdf, in, out, 1), exact = brdf->evaluateBase(in, out);
    CHECK(glm::length(base - exact) < 0.05f * glm::length(exact));
    CHECK_FALSE(factory.make("red-plastic", {}, false)[0].materials[0].hasBase);
}

TEST_CASE("material factory: unless K is given, anisotropic materials have one term more") {
    MaterialFactory factory({.method = Factorization::NonNegative}, 12, DiskMapping::EqualArea);
    const auto termsOf = [&](const char* material) {
        return factory.make(material, {}, false)[0].brdf.terms;
    };
    CHECK_EQ(termsOf("gold"), 8);
    CHECK_EQ(termsOf("brushed-steel"), 9);
    CHECK_EQ(termsOf(R"({"set": ["gold", "brushed-steel"]})"), 9);
    CHECK_EQ(smallFactory(8).make("brushed-steel", {}, false)[0].brdf.terms, 8);
}

TEST_CASE("material factory: light maps represent the base under a coat that is too narrow for its terms") {
    const std::string polished = R"({"model": "gltf", "base_color": 0.5, "roughness": 0.6, "clearcoat": 1})";
    MaterialFactory factory({.method = Factorization::NonNegative}, 32, DiskMapping::EqualArea);
    const MaterialSet set = factory.make(polished, {}, false)[0];
    CHECK(set.brdf.layers == 1);
    CHECK(set.brdf.viewMaps.size() == size_t(set.brdf.terms) * set.brdf.mapTexels());
    CHECK_FALSE(set.materials[0].hasBase);
    // Far from the mirror direction, where the base is all there is.
    const auto brdf = makeBrdf(polished);
    for (const float tilt : {0.0f, 0.3f, 0.6f, 0.9f}) {
        CAPTURE(tilt);
        const vec3 out = glm::normalize(vec3(std::sin(tilt), 0, std::cos(tilt)));
        const vec3 in = glm::normalize(vec3(0.2f, 0.7f, 0.7f));
        CHECK(evaluate(set.brdf, in, out).x > 0.5f * brdf->evaluate(in, out).x);
    }
}
