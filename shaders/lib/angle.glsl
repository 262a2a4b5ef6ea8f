// The angle of (x, y) from the x axis, in [-π, π], to 1e-7: GLSL's own atan may be off by 4096 units in the
// last place, a fraction of a pixel of an environment. Polynomial: Abramowitz and Stegun, 4.4.49.
#ifndef RELUME_LIB_ANGLE_GLSL
#define RELUME_LIB_ANGLE_GLSL

float angleOf(float y, float x) {
    const float near = min(abs(x), abs(y)), far = max(abs(x), abs(y));
    const float t = far > 0 ? near / far : 0;
    const float s = t * t;
    float series = 0.0028662257;
    series = series * s - 0.0161657367;
    series = series * s + 0.0429096138;
    series = series * s - 0.0752896400;
    series = series * s + 0.1065626393;
    series = series * s - 0.1420889944;
    series = series * s + 0.1999355085;
    series = series * s - 0.3333314528;
    float angle = t + t * s * series;
    if (abs(y) > abs(x)) angle = 1.57079632679 - angle;
    if (x < 0) angle = 3.14159265359 - angle;
    return y < 0 ? -angle : angle;
}

#endif
