// CAPTURE of a structured binding, which lambdas, as in doctest's, cannot capture in Clang before version 16.
#pragma once

#include <doctest/doctest.h>

#define CAPTURE_BINDING_AS(name, value)                                                                      \
    const auto& value = name;                                                                                \
    INFO(#name " := ", value)
#define CAPTURE_BINDING(name) CAPTURE_BINDING_AS(name, DOCTEST_ANONYMOUS(captured))
