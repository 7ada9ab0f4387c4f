#include "renderer/analysis/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

#include "renderer/analysis/comparable.h"
#include "renderer/film/display_transform.h"

namespace brume {
namespace {

constexpr double kPiD = 3.14159265358979323846;

// ---- Planes and separable filters ----------------------------------------------------------------------------------

/// Inner loops run over this many neighbours at once: a constant count lets every compiler use vector instructions.
constexpr int kBlock = 16;

/// One channel. Rows are padded on the right to whole blocks; the padding holds finite values that nobody reads.
struct Plane {
  int width = 0, height = 0, stride = 0;
  std::vector<float> values;

  Plane(int width_, int height_)
      : width(width_),
        height(height_),
        stride((width_ + kBlock - 1) / kBlock * kBlock),
        values(static_cast<std::size_t>(stride) * height_) {}
  float* row(int y) { return values.data() + static_cast<std::size_t>(y) * stride; }
  const float* row(int y) const { return values.data() + static_cast<std::size_t>(y) * stride; }
};

/// How a kernel's two halves relate. A derivative is evaluated on differences of pixels, so it is exactly 0 on a
/// constant image; otherwise rounding would look like features, and the paper's square root would magnify it (1e-8 to
/// 1e-4).
enum class Symmetry {
  Even,      ///< w(-k) = w(k)
  EvenZero,  ///< w(-k) = w(k), and the weights sum to 0
  Odd,       ///< w(-k) = -w(k)
};

/// One half of a filter of 2 * radius + 1 taps.
struct Kernel {
  Symmetry symmetry = Symmetry::Even;
  std::vector<float> weights;  ///< [radius + 1]; of x = 0, 1, .. radius
  int radius() const { return static_cast<int>(weights.size()) - 1; }
};

/// A block of sums; before(k) and after(k) are the blocks k taps to the left and right (or above and below).
template <class Before, class After>
void filter_block(const Kernel& kernel, const Before& before, const After& after, float* out) {
  const auto sum_taps = [&](float center_weight, const auto& pair) {
    const float* center = before(0);
    float sum[kBlock];
    for (int i = 0; i < kBlock; ++i) sum[i] = center_weight * center[i];
    for (int k = 1; k <= kernel.radius(); ++k) {
      const float weight = kernel.weights[static_cast<std::size_t>(k)];
      const float* a = before(k);
      const float* b = after(k);
      for (int i = 0; i < kBlock; ++i) sum[i] += weight * pair(a[i], b[i], center[i]);
    }
    std::copy_n(sum, kBlock, out);
  };
  switch (kernel.symmetry) {
    case Symmetry::Even:
      return sum_taps(kernel.weights[0], [](float a, float b, float) { return a + b; });
    case Symmetry::EvenZero:
      return sum_taps(0, [](float a, float b, float c) { return (a - c) + (b - c); });
    case Symmetry::Odd:
      return sum_taps(0, [](float a, float b, float) { return b - a; });
  }
}

/// Both directions, with `scratch` between them. Beyond the border the border pixel goes on.
void filter(const Plane& in, const Kernel& horizontal, const Kernel& vertical, Plane& scratch, Plane& out) {
  const int radius = horizontal.radius();
  std::vector<float> padded(static_cast<std::size_t>(in.stride + 2 * radius));
  for (int y = 0; y < in.height; ++y) {
    const float* row = in.row(y);
    std::fill(padded.begin(), padded.begin() + radius, row[0]);
    std::copy_n(row, in.width, padded.begin() + radius);
    std::fill(padded.begin() + radius + in.width, padded.end(), row[in.width - 1]);
    for (int x = 0; x < in.stride; x += kBlock) {
      const float* center = padded.data() + radius + x;
      filter_block(
          horizontal, [&](int k) { return center - k; }, [&](int k) { return center + k; }, scratch.row(y) + x);
    }
  }
  for (int y = 0; y < in.height; ++y)
    for (int x = 0; x < in.stride; x += kBlock)
      filter_block(
          vertical, [&](int k) { return scratch.row(std::max(y - k, 0)) + x; },
          [&](int k) { return scratch.row(std::min(y + k, in.height - 1)) + x; }, out.row(y) + x);
}

// ---- Colour spaces -------------------------------------------------------------------------------------------------

using Triple = std::array<float, 3>;
using Matrix = std::array<std::array<double, 3>, 3>;

constexpr Matrix inverse(const Matrix& m) {
  Matrix result{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      result[j][i] = m[i1][j1] * m[i2][j2] - m[i1][j2] * m[i2][j1];  // cyclic cofactors carry their sign
    }
  const double determinant = m[0][0] * result[0][0] + m[0][1] * result[1][0] + m[0][2] * result[2][0];
  for (auto& row : result)
    for (double& value : row) value /= determinant;
  return result;
}

/// Linear sRGB to XYZ divided by the white point, from the chromaticities of BT.709-6 (items 1.4 and 1.5): the columns
/// are the primaries' X : Y : Z, scaled so that white is (1, 1, 1).
constexpr Matrix rgb_to_relative_xyz() {
  constexpr double kX[3] = {0.64, 0.30, 0.15}, kY[3] = {0.33, 0.60, 0.06}, kWhiteX = 0.3127, kWhiteY = 0.3290;
  constexpr double kWhite[3] = {kWhiteX / kWhiteY, 1, (1 - kWhiteX - kWhiteY) / kWhiteY};
  Matrix m{};
  for (std::size_t c = 0; c < 3; ++c) {
    m[0][c] = kX[c] / kY[c] / kWhite[0];
    m[1][c] = 1;
    m[2][c] = (1 - kX[c] - kY[c]) / kY[c] / kWhite[2];
  }
  const Matrix to_scale = inverse(m);
  for (std::size_t c = 0; c < 3; ++c) {
    const double scale = to_scale[c][0] + to_scale[c][1] + to_scale[c][2];
    for (auto& row : m) row[c] *= scale;
  }
  return m;
}

constexpr Matrix kRgbToXyz = rgb_to_relative_xyz();
constexpr Matrix kXyzToRgb = inverse(kRgbToXyz);

Triple multiply(const Matrix& m, const Triple& v) {
  Triple result;
  for (std::size_t i = 0; i < 3; ++i)
    result[i] =
        static_cast<float>(m[i][0]) * v[0] + static_cast<float>(m[i][1]) * v[1] + static_cast<float>(m[i][2]) * v[2];
  return result;
}

/// CIE 15:2018, section 8.2.1: the cube root, with a straight line near black.
float lab_root(float t) {
  constexpr float kDelta = 6.0f / 29;
  return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0f / 29;
}

/// L*a*b* of linear RGB, with chroma scaled by lightness: dark colours look less colourful ("Perceptually uniform color
/// space"; Hunt 1952).
Triple hunt_lab(const Triple& rgb) {
  const Triple xyz = multiply(kRgbToXyz, rgb);
  const float fx = lab_root(xyz[0]), fy = lab_root(xyz[1]), fz = lab_root(xyz[2]);
  const float lightness = 116 * fy - 16;
  return {lightness, 0.01f * lightness * 500 * (fx - fy), 0.01f * lightness * 200 * (fy - fz)};
}

/// Distance for large colour differences ("Color metric"; Abasi et al. 2020).
float hyab(const Triple& p, const Triple& q) {
  const float da = p[1] - q[1], db = p[2] - q[2];
  return std::abs(p[0] - q[0]) + std::sqrt(da * da + db * db);
}

/// A linear version of L*a*b* in which filtering is meaningful ("Spatial filtering"; Flohr et al. 1993).
struct OpponentImage {
  Plane y, cx, cz;
};

/// @param linear_at  linear RGB in [0, 1] of pixel (x, y)
template <class LinearAt> OpponentImage to_opponent(int width, int height, const LinearAt& linear_at) {
  OpponentImage result{Plane(width, height), Plane(width, height), Plane(width, height)};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Triple xyz = multiply(kRgbToXyz, linear_at(x, y));
      result.y.row(y)[x] = 116 * xyz[1] - 16;
      result.cx.row(y)[x] = 500 * (xyz[0] - xyz[1]);
      result.cz.row(y)[x] = 200 * (xyz[1] - xyz[2]);
    }
  return result;
}

OpponentImage to_opponent(const Image8& image) {
  std::array<float, 256> decoded;
  for (std::size_t code = 0; code < 256; ++code)
    decoded[code] = static_cast<float>(srgb_decode(static_cast<double>(code) / 255));
  return to_opponent(image.width, image.height, [&](int x, int y) {
    const std::uint8_t* code = image.at(x, y);
    return Triple{decoded[code[0]], decoded[code[1]], decoded[code[2]]};
  });
}

OpponentImage to_opponent(const Image& image) {
  return to_opponent(image.width, image.height, [&](int x, int y) {
    const Color& c = image.at(x, y);
    return Triple{std::clamp(c.r, 0.0f, 1.0f), std::clamp(c.g, 0.0f, 1.0f), std::clamp(c.b, 0.0f, 1.0f)};
  });
}

Triple opponent_to_rgb(float y, float cx, float cz) {
  const float relative_y = (y + 16) / 116;
  return multiply(kXyzToRgb, {relative_y + cx / 500, relative_y, relative_y - cz / 200});
}

// ---- Colour pipeline -----------------------------------------------------------------------------------------------

/// One term of a contrast sensitivity function in space, a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees.
struct CsfTerm {
  double a, b;
};

// The paper's table of CSF constants; the blue-yellow function is a sum of two.
constexpr CsfTerm kAchromatic{1, 0.0047}, kRedGreen{1, 0.0053}, kBlueYellow1{34.1, 0.04}, kBlueYellow2{13.5, 0.025};

/// A term as a separable kernel of weight 1, and the weight that the paper's normalisation of the two-dimensional sum
/// gives it before it is divided by the sum over all terms.
struct CsfKernel {
  Kernel kernel;
  double weight;
};

CsfKernel csf_kernel(CsfTerm term, double ppd) {
  // All functions share the radius of the widest, 3 standard deviations of b = 0.04 .
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(kBlueYellow1.b / (2 * kPiD * kPiD)) * ppd));
  std::vector<double> values;
  double sum = 0;
  for (int k = 0; k <= radius; ++k) {
    const double x = k / ppd;
    values.push_back(std::exp(-kPiD * kPiD * x * x / term.b));
    sum += (k == 0 ? 1 : 2) * values.back();
  }
  CsfKernel result;
  for (const double value : values) result.kernel.weights.push_back(static_cast<float>(value / sum));
  result.weight = term.a * std::sqrt(kPiD / term.b) * sum * sum;
  return result;
}

void filter_contrast_sensitivity(OpponentImage& image, double ppd) {
  Plane scratch = image.y, first = image.y;
  const auto smooth = [&](const Plane& in, const CsfKernel& csf, Plane& out) {
    filter(in, csf.kernel, csf.kernel, scratch, out);
  };
  smooth(image.y, csf_kernel(kAchromatic, ppd), image.y);
  smooth(image.cx, csf_kernel(kRedGreen, ppd), image.cx);
  const CsfKernel wide = csf_kernel(kBlueYellow1, ppd), narrow = csf_kernel(kBlueYellow2, ppd);
  smooth(image.cz, wide, first);
  smooth(image.cz, narrow, image.cz);
  const float share = static_cast<float>(wide.weight / (wide.weight + narrow.weight));
  for (std::size_t i = 0; i < first.values.size(); ++i)
    image.cz.values[i] = share * first.values[i] + (1 - share) * image.cz.values[i];
}

/// What the eye resolves of `image` and the monitor can show, in Hunt-adjusted L*a*b*; replaces Y, Cx, Cz.
void to_perceived(OpponentImage& image, double ppd) {
  filter_contrast_sensitivity(image, ppd);
  for (int y = 0; y < image.y.height; ++y)
    for (int x = 0; x < image.y.width; ++x) {
      Triple rgb = opponent_to_rgb(image.y.row(y)[x], image.cx.row(y)[x], image.cz.row(y)[x]);
      for (float& value : rgb) value = std::clamp(value, 0.0f, 1.0f);
      const Triple lab = hunt_lab(rgb);
      image.y.row(y)[x] = lab[0], image.cx.row(y)[x] = lab[1], image.cz.row(y)[x] = lab[2];
    }
}

/// "Error redistribution": the distance, compressed by q_c and mapped to [0, 1] so that the rare huge distances above
/// p_c c_max share the top 1 - p_t.
class ErrorScale {
 public:
  ErrorScale() : maximum_(std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), kQc)) {}
  float operator()(float distance) const {
    const float error = std::pow(distance, kQc), knee = kPc * maximum_;
    if (error < knee) return kPt / knee * error;
    return std::min(1.0f, kPt + (error - knee) / (maximum_ - knee) * (1 - kPt));
  }

 private:
  static constexpr float kQc = 0.7f, kPc = 0.4f, kPt = 0.95f;
  float maximum_;  ///< between the two colours of the gamut that are furthest apart, green and blue
};

// ---- Feature pipeline ----------------------------------------------------------------------------------------------

struct FeatureKernels {
  Kernel smooth, edge, point;
};

/// A Gaussian, its first and its second derivative ("Feature pipeline"). Positive weights of a derivative sum to 1,
/// negative ones to -1; since the Gaussian of the other direction sums to 1, that holds in two dimensions too.
FeatureKernels feature_kernels(double ppd) {
  constexpr double kWidth = 0.082;  // degrees from peak to trough of the eye's edge detector
  const double sigma = 0.5 * kWidth * ppd;
  const int radius = static_cast<int>(std::ceil(3 * sigma));
  std::vector<double> smooth, edge, point;
  double smooth_sum = 0, edge_sum = 0, positive_sum = 0, negative_sum = 0;
  for (int k = 0; k <= radius; ++k) {
    const double g = std::exp(-k * k / (2 * sigma * sigma)), both_sides = k == 0 ? 1 : 2;
    smooth.push_back(g);
    edge.push_back(k * g);
    point.push_back((k * k / (sigma * sigma) - 1) * g);
    smooth_sum += both_sides * smooth.back();
    edge_sum += edge.back();
    (point.back() > 0 ? positive_sum : negative_sum) += both_sides * std::abs(point.back());
  }
  FeatureKernels kernels{{Symmetry::Even, {}}, {Symmetry::Odd, {}}, {Symmetry::EvenZero, {}}};
  for (std::size_t k = 0; k < smooth.size(); ++k) {
    kernels.smooth.weights.push_back(static_cast<float>(smooth[k] / smooth_sum));
    kernels.edge.weights.push_back(static_cast<float>(edge[k] / edge_sum));
    kernels.point.weights.push_back(static_cast<float>(point[k] / (point[k] > 0 ? positive_sum : negative_sum)));
  }
  return kernels;
}

/// Length of the gradient, and its like for second derivatives, of luminance in [0, 1].
struct Features {
  Plane edge, point;
};

Features detect_features(const Plane& lightness, double ppd) {
  const FeatureKernels kernels = feature_kernels(ppd);
  Plane luminance = lightness, scratch = lightness, other = lightness;
  for (float& value : luminance.values) value = (value + 16) / 116;

  const auto strength = [&](const Kernel& derivative) {
    Plane result(luminance.width, luminance.height);
    filter(luminance, derivative, kernels.smooth, scratch, result);
    filter(luminance, kernels.smooth, derivative, scratch, other);
    for (std::size_t i = 0; i < result.values.size(); ++i)
      result.values[i] = std::sqrt(result.values[i] * result.values[i] + other.values[i] * other.values[i]);
    return result;
  };
  return {strength(kernels.edge), strength(kernels.point)};
}

// ---- Both together -------------------------------------------------------------------------------------------------

FlipResult compare(OpponentImage a, OpponentImage b, double ppd) {
  const Features features_a = detect_features(a.y, ppd), features_b = detect_features(b.y, ppd);
  to_perceived(a, ppd);
  to_perceived(b, ppd);

  const int width = a.y.width, height = a.y.height;
  FlipResult result{width, height, {}, 0};
  result.error.reserve(static_cast<std::size_t>(width) * height);
  const ErrorScale scale;
  double sum = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float distance =
          hyab({a.y.row(y)[x], a.cx.row(y)[x], a.cz.row(y)[x]}, {b.y.row(y)[x], b.cx.row(y)[x], b.cz.row(y)[x]});
      const float edge = std::abs(features_a.edge.row(y)[x] - features_b.edge.row(y)[x]);
      const float point = std::abs(features_a.point.row(y)[x] - features_b.point.row(y)[x]);
      // "Feature metric", q_f = 1/2; a gradient of (1, 1) is the largest, hence the root of 2.
      const float feature = std::min(1.0f, std::sqrt(std::max(edge, point) * 0.70710678f));
      const float error = std::pow(scale(distance), 1 - feature);  // "Final difference"
      result.error.push_back(error);
      sum += error;
    }
  result.mean = sum / static_cast<double>(result.error.size());
  return result;
}

/// Of pictures of bytes or of light.
template <class Picture>
Result<FlipResult> checked_flip(const Picture& test, const Picture& reference, const FlipSettings& settings) {
  const double ppd = settings.pixels_per_degree;
  // Below 4 the feature filters have no neighbours left to weigh; above 1000 they are wider than most pictures.
  if (!(ppd >= 4 && ppd <= 1000))
    return bad_input("found " + std::to_string(ppd) + " pixels per degree, expected 4 to 1000");
  if (std::optional<Error> error = not_comparable(test, reference)) return *error;
  return compare(to_opponent(test), to_opponent(reference), ppd);
}

}  // namespace

Result<FlipResult> flip(const Image8& test, const Image8& reference, const FlipSettings& settings) {
  return checked_flip(test, reference, settings);
}

Result<FlipResult> flip_linear(const Image& test, const Image& reference, const FlipSettings& settings) {
  return checked_flip(test, reference, settings);
}

std::array<std::uint8_t, 3> heat_color(float value) {
  constexpr std::array<std::array<float, 3>, 9> kColors = {{{0, 0, 4},
                                                            {29, 17, 71},
                                                            {81, 18, 124},
                                                            {130, 38, 129},
                                                            {182, 54, 121},
                                                            {230, 81, 100},
                                                            {251, 136, 97},
                                                            {254, 194, 135},
                                                            {252, 253, 191}}};
  const float position = (value > 0 ? std::min(value, 1.0f) : 0.0f) * (kColors.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(position), kColors.size() - 2);
  const float fraction = position - static_cast<float>(i);
  std::array<std::uint8_t, 3> color{};
  for (std::size_t c = 0; c < 3; ++c)
    color[c] = static_cast<std::uint8_t>(kColors[i][c] + fraction * (kColors[i + 1][c] - kColors[i][c]) + 0.5f);
  return color;
}

Image8 heat_map(const FlipResult& result) {
  Image8 image(result.width, result.height, 3);
  for (std::size_t i = 0; i < result.error.size(); ++i) {
    const std::array<std::uint8_t, 3> color = heat_color(result.error[i]);
    std::copy(color.begin(), color.end(), image.bytes.begin() + static_cast<std::ptrdiff_t>(3 * i));
  }
  return image;
}

}  // namespace brume
