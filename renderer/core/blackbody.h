// The colour of glowing soot.
#pragma once

#include "renderer/core/vec.h"

namespace brume {

/// Colour of a black body in linear Rec. 709, with luminance 1: Planck's law weighed by the CIE 1931 colour matching
/// functions. Below some 1900 K the colour is redder than Rec. 709 can show; its blue is cut off at 0.
/// Wyman, Sloan & Shirley 2013, "Simple Analytic Approximations to the CIE XYZ Color Matching Functions", listing 1.
/// @param kelvin  > 0
Color blackbody_color(double kelvin);

/// Glow of a black body as a picture can show it: blackbody_color() times (kelvin / 3000)^4, the law of Stefan and
/// Boltzmann, so that the luminance is 1 at 3000 K and 1/16 at 1500 K. Planck's own visible radiance would differ by a
/// factor of thousands between the two. Fades in from 500 K to 1000 K. Tabulated; colours end at 12000 K.
Color blackbody_glow(float kelvin);

}  // namespace brume
