#include "renderer/integrators/light_batch.h"

#include "renderer/integrators/incoming_light.h"
#include "renderer/march/product_sampling.h"
#include "renderer/march/tracking.h"

namespace brume {

template <int C> struct LightBatch<C>::Sample {
  const Light& light;
  LightPoint point;
  ShadowNumbers numbers;
  DistanceTechnique technique;
  bool combined;      // as in Technique
  bool plain;         // all that there is to know of the light is its point
  bool near = false;  // to the light's point, in a segment that varies: the record knows another place of it only

  bool is_about() const { return technique == DistanceTechnique::Equiangular; }
  /// Whether a density about its point counts.
  bool is_aimed() const { return combined || is_about(); }
};

template <int C>
LightBatch<C>::LightBatch(const MarchRecord<C>& record, const Ray& ray, Color beta, int bounce, SampleContext& context,
                          MarchedShadows<C>& shadows)
    : record_(record),
      ray_(ray),
      beta_(beta),
      bounce_(bounce),
      context_(context),
      shadows_(shadows),
      density_(record, PlaceInSegment::LookedUp),
      samples_(context.arena.alloc_span<Sample>(kCapacity).data()) {}

/// Whether a sample is seen by one phase function and nothing is in its way but the medium, nor does the light look so
/// large that it is looked for by chance.
template <int C> bool LightBatch<C>::is_plain(const Light& light) const {
  const Scene& scene = context_.scene;
  if (record_.medium_density || scene.surfaces || light.kind() == LightPoint::Kind::Environment || light.own_shadow())
    return false;
  return !scene.needs.large_lights ||
         !is_large(light.largest_solid_angle({ray_.origin, ray_.direction, record_.span()}), scene.phase_peak);
}

template <int C>
void LightBatch<C>::add(const Technique& technique, bool plain, float u, Vec2 u_point, const ShadowNumbers& numbers) {
  // Made where it stays: a copy would wait for what has just been written.
  Sample& s = *new (&samples_[n_]) Sample{
      technique.light, technique.light.sample_point(u_point), numbers, technique.distance, technique.combined, plain};
  if (s.is_aimed()) {
    const Interval lit = lit_part(record_, ray_, s.light, s.point);
    if (s.is_about() && lit.empty()) return;
    about_.aim(n_, s.point.position, lit);
    u_[n_] = u;
  }
  lights_.set(n_, s.point);
  weights_.factor[n_] = technique.factor;
  weights_.pdf_ratio[n_] = 1;
  weights_.drawn[n_] = (s.is_about() ? LightWeights<C>::kAbout : 0) | (s.combined ? LightWeights<C>::kCombined : 0);
  if (++n_ == kCapacity) finish();
}

/// @param unaimed  density there by the technique that knows nothing of the point of the light
template <int C> void LightBatch<C>::put(int k, const RayPoint<C>& at, float unaimed) {
  t_[k] = at.t, segment_[k] = at.segment;
  for (int c = 0; c < C; ++c) weights_.scattered[c][k] = at.sigma_s[c] * at.transmittance[c], weights_.left[c][k] = 0;
  weights_.unaimed[k] = unaimed;
}

/// At the place where a segment was looked up.
/// @param probability  with which the technique that knows nothing of the light's point draws the segment
template <int C> void LightBatch<C>::put_looked_up(int k, int segment, float probability) {
  const float before = record_.looked_up_behind(segment);
  t_[k] = record_.t[segment] + before, segment_[k] = segment;
  for (int c = 0; c < C; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    weights_.scattered[c][k] = record_.sigma_s[channel][segment] * record_.transmittance[channel][segment];
    weights_.left[c][k] = record_.sigma_t[channel][segment] * before;  // still as an optical depth
  }
  weights_.unaimed[k] = probability / record_.segment(segment).length();
}

template <int C>
template <class Places>
void LightBatch<C>::add_at(const Technique& technique, const Places& places, const LightNumbers& numbers,
                           const LightNumbers::Distances& u, int count) {
  const bool plain = is_plain(technique.light);
  DrawnSegment drawn[kCapacity];
  for (int begin = 0; begin < count;) {
    const int group = std::min(count - begin, kCapacity - n_);
    for (int j = 0; j < group; ++j) drawn[j] = places.draw(u(begin + j, count));
    for (int j = 0; j < group; ++j) {
      const int segment = drawn[j].segment;
      if (places.is_looked_up(segment)) {
        put_looked_up(n_, segment, places.probability(segment));
      } else {
        const SampledPoint<C> place = places.place(drawn[j]);
        put(n_, place.at, place.pdf_t);
      }
      add(technique, plain, 0, numbers.point(begin + j), numbers.of_shadow(begin + j));
    }
    begin += group;
  }
}

template <int C>
void LightBatch<C>::add_about(const Technique& technique, const LightNumbers& numbers, const LightNumbers::Distances& u,
                              int first, int count) {
  const bool plain = is_plain(technique.light);
  for (int j = 0; j < count; ++j)
    add(technique, plain, u(j, count), numbers.point(first + j), numbers.of_shadow(first + j));
}

template <int C> void LightBatch<C>::place_about() {
  LaneArray<float> t;
  about_.measure(ray_, n_);
  about_.sample(u_, t);
  for (int k = 0; k < n_; ++k) {
    Sample& s = samples_[k];
    if (!s.is_about()) continue;
    const int i = find_segment(record_, t[k]);
    if (!follows(k, i)) {
      put_looked_up(k, i, density_.probability(i));
      continue;
    }
    const RayPoint<C> at = evaluate(record_, t[k], i);
    put(k, at, density_.pdf(at));
    s.near = !record_.is_homogeneous(i);
  }
}

template <int C> bool LightBatch<C>::look_closely(int k) {
  const ArenaScope scope(context_.arena);
  const Scene& scene = context_.scene;
  Sample& s = samples_[k];
  const Vec3 x = ray_.at(t_[k]);
  const LightTechnique<C> technique(s.light, context_, bounce_, s.numbers.index);
  const auto saw = [&](const IncomingLight& in) {
    lights_.replace(k, in.wi, in.distance, in.scattered);
    weights_.phase[k] = 1, weights_.pdf_ratio[k] = in.pdf_ratio;
    return in.by_chance;
  };
  const int i = segment_[k];
  if (s.near) {
    const Collision<C> there =
        collision_at<C>(scene.media, ray_, t_[k], scene.render.time, context_.arena, context_.statistics.march);
    const Spectrum<C> transmittance = evaluate(record_, t_[k], i).transmittance;
    for (int c = 0; c < C; ++c) weights_.scattered[c][k] = there.sigma_s[c] * transmittance[c];
    return saw(technique.towards(s.point, x, PhaseMixture<C>(scene, ray_.direction, there.densities)));
  }
  const PhaseMixture<C> phase(scene, ray_.direction, record_, i, context_.arena);
  if (s.is_about()) return saw(technique.towards(s.point, x, phase));
  if (!saw(technique.draw(s.point, x, phase)) || !s.combined) return false;
  about_.aim(k, s.point.position, lit_part(record_, ray_, s.light, s.point));
  return true;
}

template <int C> void LightBatch<C>::find_pdfs() {
  LaneArray<float> begin, end;
  for (int k = 0; k < n_; ++k) {
    if (!samples_[k].is_aimed()) continue;
    const Interval part = follows(k, segment_[k]) ? Interval{t_[k], t_[k]} : record_.segment(segment_[k]);
    begin[k] = part.begin, end[k] = part.end;
  }
  about_.pdf(begin, end, weights_.equiangular);
}

template <int C> void LightBatch<C>::hand_over(int k) {
  const Sample& s = samples_[k];
  const Color carried{weights_.carried[0][k], weights_.carried[1][k], weights_.carried[2][k]};
  if (is_black(carried)) return;
  context_.note(bounce_, lights_.x(k), s.technique, carried);
  shadows_.add(s.light, {lights_.x(k), lights_.wi(k), {0, lights_.distance(k)}}, carried, s.numbers);
}

template <int C> void LightBatch<C>::finish() {
  if (n_ == 0) return;
  const Scene& scene = context_.scene;
  bool aimed = false;
  for (int k = 0; k < n_; ++k) aimed |= samples_[k].is_aimed();
  if (aimed) place_about();
  lights_.look(ray_, t_, n_);
  scene.phases[0]->values(lights_.cosine().v, n_, weights_.phase.v);
  for (int c = 0; c < C; ++c) exp_minus(weights_.left[c].v, n_);
  bool aimed_anew = false;
  for (int k = 0; k < n_; ++k)
    if (!samples_[k].plain || samples_[k].near) aimed_anew |= look_closely(k);
  if (aimed_anew) about_.measure(ray_, n_);
  if (aimed) find_pdfs();
  carry(weights_, lights_, beta_, scene.render.mis_heuristic, n_);
  for (int k = 0; k < n_; ++k) hand_over(k);
  n_ = 0;
}

template class LightBatch<1>;
template class LightBatch<3>;
template void LightBatch<1>::add_at(const Technique&, const DensitySampling<1>&, const LightNumbers&,
                                    const LightNumbers::Distances&, int);
template void LightBatch<3>::add_at(const Technique&, const DensitySampling<3>&, const LightNumbers&,
                                    const LightNumbers::Distances&, int);
template void LightBatch<1>::add_at(const Technique&, const ProductSampling<1>&, const LightNumbers&,
                                    const LightNumbers::Distances&, int);
template void LightBatch<3>::add_at(const Technique&, const ProductSampling<3>&, const LightNumbers&,
                                    const LightNumbers::Distances&, int);

}  // namespace brume
