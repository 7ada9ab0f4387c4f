// From scene-linear radiance to the bytes of a monitor. For looking only: nothing measured ever passes through here.
#pragma once

#include "renderer/film/image.h"

namespace brume {

enum class DisplayCurve {
  Srgb,    ///< exact for displays; clips at 1
  Gamma,   ///< v = x^(1/gamma); clips at 1
  Filmic,  ///< Hable 2010, then sRGB; rolls highlights off, clips at 5.6
};

struct DisplaySettings {
  float exposure_stops = 0;  ///< radiance is multiplied by 2^stops first; [-64, 64], clamped; not a number counts as 0
  DisplayCurve curve = DisplayCurve::Srgb;
  float gamma = 2.2f;   ///< of DisplayCurve::Gamma; [1, 4], clamped; not a number counts as 2.2
  bool dither = false;  ///< ordered dithering by less than one code value, against banding in smooth haze

  bool operator==(const DisplaySettings&) const = default;
};

/// Opto-electronic transfer of sRGB, IEC 61966-2-1:1999, section 5.2; odd around 0 is not continued: x < 0 gives 0.
/// @param x  linear, [0, 1]; beyond 1 the power law goes on.    @return encoded, 1 for 1.
double srgb_encode(double x);
/// Its inverse.
double srgb_decode(double v);

/// Hable 2010, "Filmic Tonemapping Operators" (filmicworlds.com): U(2 x) / U(11.2) with
/// U(x) = (x (A x + C B) + D E) / (x (A x + B) + D F) - E/F and his constants.
/// Linear in, linear out; 0 to 0, 5.6 to 1.
///
/// Chosen over the other common fit (Narkowicz 2016, "ACES Filmic Tone Mapping Curve") by what each does to smoke. The
/// dark toe of the ACES fit shows radiance 0.01 at 0.0038, so thin haze sinks into black and looks like a density that
/// was cut off; Hable's keeps twice as much (0.0077). Both clip near the same place, and Hable's longer, flatter
/// shoulder keeps the shading of bright cloud tops and the layers within a flame. The price is a duller middle: raise
/// exposure.
double hable_filmic(double x);

/// One channel through exposure and curve, unrounded: the definition that to_display() rounds, for legends and tests.
/// @param x  scene-linear radiance; negative counts as 0.    @return [0, 1]; not a number stays so.
double display_value(double x, const DisplaySettings& settings);

/// The picture as bytes: round(255 * display_value()), exact but for ties and always monotone in the input; a pixel
/// with a NaN or an infinity in any channel is loud magenta (255, 0, 255). With `dither` the value is rounded up or
/// down by an 8x8 Bayer pattern (Bayer 1973, "An optimum method for two-level rendition of continuous-tone pictures"),
/// the same for all channels, so grey stays grey and code values that are hit exactly stay flat. The same picture gives
/// the same bytes at every call. Reuses the memory of `display`; allocates only when its size has changed.
/// @param channels  3, or 4 with alpha 255 (what graphics cards like to upload).
/// Cost: 1.6 ns per value, 2.5 ns with dithering: 1280x720 takes 4.5 ms (7 ms) on one core (EPYC, -O2).
void to_display(const Image& image, const DisplaySettings& settings, int channels, Image8& display);
Image8 to_display(const Image& image, const DisplaySettings& settings, int channels = 3);

}  // namespace brume
