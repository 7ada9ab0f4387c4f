#include "renderer/sampling/scramble.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/sampling/scramble.cpp"
#include <hwy/foreach_target.h>  // compiles this file once per instruction set

#include <hwy/highway.h>

#include "renderer/sampling/pixel_blocks.h"

HWY_BEFORE_NAMESPACE();
namespace brume::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<std::uint32_t, 16>;
using V = hn::Vec<D>;

HWY_INLINE V set(std::uint32_t v) { return hn::Set(D(), v); }
HWY_INLINE V load(const JointArray<std::uint32_t>& values, std::size_t i) { return hn::LoadU(D(), values.data() + i); }

/// 32 random bits for each dimension, from a key of 64 bits. Wellons 2018, "Prospecting for Hash Functions", two
/// rounds, between which the upper half of the key comes in.
HWY_INLINE V hash(std::uint64_t key, V salt) {
  V h = hn::Xor(salt, set(static_cast<std::uint32_t>(key)));
  h = hn::Mul(hn::Xor(h, hn::ShiftRight<16>(h)), set(0x21f0aaadu));
  h = hn::Add(h, set(static_cast<std::uint32_t>(key >> 32)));
  h = hn::Mul(hn::Xor(h, hn::ShiftRight<15>(h)), set(0xd35a2d97u));
  return hn::Xor(h, hn::ShiftRight<15>(h));
}

template <int kBy> HWY_INLINE V swap_groups(V v, V low) {
  return hn::Or(hn::And(hn::ShiftRight<kBy>(v), low), hn::ShiftLeft<kBy>(hn::And(v, low)));
}
HWY_INLINE V reverse_bits(V v) {
  v = swap_groups<1>(v, set(0x55555555u));
  v = swap_groups<2>(v, set(0x33333333u));
  v = swap_groups<4>(v, set(0x0f0f0f0fu));
  v = swap_groups<8>(v, set(0x00ff00ffu));
  return swap_groups<16>(v, set(0x0000ffffu));
}

/// Owen scrambling of digits in reverse: every bit is flipped by a hash of the bits below it.
/// Laine & Karras 2011, "Stratified Sampling for Stochastic Transparency", section 3.1; this hash by Vegdahl 2021,
/// "Building a Better LK Hash". After one round some pairs of dimensions are correlated in their first digits.
HWY_INLINE V laine_karras_round(V x, V seed) {
  x = hn::Xor(x, hn::Mul(x, set(0x3d20adeau)));
  x = hn::Add(x, seed);
  x = hn::Mul(x, hn::Or(hn::ShiftRight<16>(seed), set(1)));
  x = hn::Xor(x, hn::Mul(x, set(0x05526c56u)));
  return hn::Xor(x, hn::Mul(x, set(0x53a22864u)));
}

/// Owen scrambling of the first digits: 15 random bits tell for each whether it is flipped, by the ones before it.
HWY_INLINE V scramble_first_digits(V x, V bits) {
  const V one = set(1);
  const auto flip = [&](std::uint32_t first, std::uint32_t before)
                        HWY_ATTR { return hn::And(hn::Shr(bits, hn::Add(set(first), hn::And(x, set(before)))), one); };
  V flips = hn::And(bits, one);
  flips = hn::Or(flips, hn::ShiftLeft<1>(flip(1, 1)));
  flips = hn::Or(flips, hn::ShiftLeft<2>(flip(3, 3)));
  flips = hn::Or(flips, hn::ShiftLeft<3>(flip(7, 7)));
  return hn::Xor(x, flips);
}

/// `bits` with those exchanged with which 0, the digits of the first pass, becomes `target`.
HWY_INLINE V with_zero_to(V target, V bits) {
  const V lowest_two = hn::And(target, set(3));
  const V third = hn::ShiftLeft<1>(hn::And(target, set(4))), fourth = hn::ShiftLeft<4>(hn::And(target, set(8)));
  return hn::Or(hn::AndNot(set(3 | 1 << 3 | 1 << 7), bits), hn::Or(lowest_two, hn::Or(third, fourth)));
}

void Scramble(const JointArray<std::uint32_t>& digits, const JointKeys& keys, JointArray<float>& numbers) {
  const D d;
  const hn::RebindToSigned<D> di;
  const hn::RebindToFloat<D> df;
  const V first = set(kBlockPixels - 1);
  for (std::size_t i = 0; i < kJointDimensions; i += hn::Lanes(d)) {
    const V x = load(digits, i), salt = load(kDimensionSalts, i);
    const V seed = hash(keys.pixel, salt);
    const V target = scramble_first_digits(load(kBlockDigits[keys.place], i), hash(keys.block, salt));
    const V own = hn::ShiftRight<16>(hn::Mul(seed, set(0x9e3779b9u)));
    const V low = scramble_first_digits(hn::And(x, first), with_zero_to(target, own));
    const V bits = reverse_bits(hn::Or(hn::AndNot(first, laine_karras_round(x, seed)), low));
    // The upper 24 bits, so that the float is exact and stays below 1.
    const auto upper = hn::ConvertTo(df, hn::BitCast(di, hn::ShiftRight<8>(bits)));
    hn::StoreU(hn::Mul(upper, hn::Set(df, 0x1p-24f)), df, numbers.data() + i);
  }
}

}  // namespace
}  // namespace brume::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume {

HWY_EXPORT(Scramble);

void scramble(const JointArray<std::uint32_t>& digits, const JointKeys& keys, JointArray<float>& numbers) {
  HWY_DYNAMIC_DISPATCH(Scramble)(digits, keys, numbers);
}

}  // namespace brume
#endif  // HWY_ONCE
