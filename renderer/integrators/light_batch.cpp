#include "renderer/integrators/light_batch.h"

#include "renderer/march/mis.h"
#include "renderer/march/product_sampling.h"
#include "renderer/march/tracking.h"

namespace brume {

template <int C> struct LightBatch<C>::Sample {
  /// Whether a density about its point counts.
  bool is_about() const { return combined || technique == DistanceTechnique::Equiangular; }

  const Light& light;
  LightPoint point;
  ShadowNumbers numbers;
  DistanceTechnique technique;
  float factor;  // becomes what multiplies the integrand: the weight over the density
  bool combined;
  float u;       // number that will draw the distance by equi-angular sampling
  Interval lit;  // the part of the ray that the point can reach, where a density about it counts
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
      samples_(context.arena.alloc_span<Sample>(kCapacity).data()),
      points_(context.arena.alloc_span<SampledPoint<C>>(kCapacity).data()),
      incoming_(context.arena.alloc_span<IncomingLight>(kCapacity).data()) {}

template <int C>
void LightBatch<C>::add(const Technique& technique, float u, Vec2 u_point, const ShadowNumbers& numbers) {
  // Made where it stays: a copy would wait for what has just been written.
  Sample& s = *new (&samples_[n_]) Sample{technique.light,
                                          technique.light.sample_point(u_point),
                                          numbers,
                                          technique.distance,
                                          technique.factor,
                                          technique.combined,
                                          u,
                                          {}};
  if (s.is_about()) s.lit = lit_part(record_, ray_, s.light, s.point);
  if (s.technique == DistanceTechnique::Equiangular && s.lit.empty()) return;
  if (++n_ == kCapacity) finish();
}

template <int C>
template <class Places>
void LightBatch<C>::add_at(const Technique& technique, const Places& places, const LightNumbers& numbers,
                           const LightNumbers::Distances& u, int count) {
  DrawnSegment drawn[kCapacity];
  for (int begin = 0; begin < count;) {
    const int first = n_, group = std::min(count - begin, kCapacity - n_);
    for (int j = 0; j < group; ++j) drawn[j] = places.draw(u(begin + j, count));
    for (int j = 0; j < group; ++j) new (&points_[first + j]) SampledPoint<C>(places.place(drawn[j]));
    for (int j = 0; j < group; ++j) {
      if (!(points_[first + j].pdf_t > 0)) continue;
      if (n_ < first + j) points_[n_] = points_[first + j];
      add(technique, 0, numbers.point(begin + j), numbers.of_shadow(begin + j));
    }
    begin += group;
  }
}

template <int C>
void LightBatch<C>::add_about(const Technique& technique, float u, Vec2 u_point, const ShadowNumbers& numbers) {
  add(technique, u, u_point, numbers);
}

template <int C> void LightBatch<C>::place_about(EquiangularLanes& lanes) {
  alignas(64) float u[kCapacity], t[kCapacity];
  for (int k = 0; k < n_; ++k) {
    u[k] = samples_[k].u;
    lanes.aim(k, samples_[k].point.position, samples_[k].lit);
  }
  lanes.measure(ray_);
  lanes.sample(u, t);
  for (int k = 0; k < n_; ++k) {
    if (samples_[k].technique != DistanceTechnique::Equiangular) continue;
    const int i = find_segment(record_, t[k]);
    new (&points_[k].at) RayPoint<C>(follows(lanes, k, i) ? evaluate(record_, t[k], i) : looked_up_point(record_, i));
  }
}

template <int C> bool LightBatch<C>::look_at_light(int k, EquiangularLanes& lanes) {
  const ArenaScope scope(context_.arena);
  const Scene& scene = context_.scene;
  Sample& s = samples_[k];
  RayPoint<C>& at = points_[k].at;
  IncomingLight& in = incoming_[k];  // made there, as in add()
  const Vec3 x = ray_.at(at.t);
  const LightTechnique<C> technique(s.light, context_, bounce_, s.numbers.index);
  const auto phase = [&] { return PhaseMixture<C>(scene, ray_.direction, record_, at.segment, context_.arena); };
  if (s.technique != DistanceTechnique::Equiangular) {
    new (&in) IncomingLight(technique.draw(s.point, x, phase()));
    if (!in.by_chance || !s.combined) return false;
    lanes.aim(k, s.point.position, lit_part(record_, ray_, s.light, s.point));
    return true;
  }
  if (!record_.is_homogeneous(at.segment) && lanes.is_near(k, record_.segment(at.segment))) {
    // The record knows another place of the segment only.
    const Collision<C> there =
        collision_at<C>(scene.media, ray_, at.t, scene.render.time, context_.arena, context_.statistics.march);
    at.sigma_s = there.sigma_s;
    new (&in) IncomingLight(technique.towards(s.point, x, PhaseMixture<C>(scene, ray_.direction, there.densities)));
  } else {
    new (&in) IncomingLight(technique.towards(s.point, x, phase()));
  }
  return false;
}

template <int C> void LightBatch<C>::weigh(const EquiangularLanes& lanes) {
  alignas(64) float begin[kCapacity], end[kCapacity], equiangular[kCapacity];
  for (int k = 0; k < lanes.size(); ++k) {
    const RayPoint<C>& at = points_[k].at;
    const Interval part = follows(lanes, k, at.segment) ? Interval{at.t, at.t} : record_.segment(at.segment);
    begin[k] = part.begin, end[k] = part.end;
  }
  lanes.pdf(begin, end, equiangular);
  const MisHeuristic heuristic = context_.scene.render.mis_heuristic;
  for (int k = 0; k < n_; ++k) {
    Sample& s = samples_[k];
    const bool about = s.technique == DistanceTechnique::Equiangular;
    const float pdf = about ? equiangular[k] : points_[k].pdf_t;
    if (!(pdf > 0)) {  // on the border of the lit part: of no use
      s.factor = 0;
      continue;
    }
    float weight = 1;
    if (s.combined) {
      const float ratio = incoming_[k].pdf_ratio;
      weight = about ? mis_weight(heuristic, pdf, density_.pdf(points_[k].at) * ratio)
                     : mis_weight(heuristic, pdf * ratio, equiangular[k]);
    }
    s.factor *= weight / pdf;
  }
}

template <int C> void LightBatch<C>::hand_over(int k) {
  const Sample& s = samples_[k];
  const RayPoint<C>& at = points_[k].at;
  const IncomingLight& in = incoming_[k];
  Color carried = beta_ * in.scattered * s.factor;
  for (int c = 0; c < 3; ++c) {
    const int channel = C == 1 ? 0 : c;
    carried[c] *= at.sigma_s[channel] * at.transmittance[channel];
  }
  if (is_black(carried)) return;
  context_.note(bounce_, ray_.at(at.t), s.technique, carried);
  shadows_.add(s.light, {ray_.at(at.t), in.wi, {0, in.distance}}, carried, s.numbers);
}

template <int C> void LightBatch<C>::finish() {
  if (n_ == 0) return;
  const ArenaScope scope(context_.arena);
  bool about = false;
  for (int k = 0; k < n_; ++k) about |= samples_[k].is_about();
  EquiangularLanes lanes(about ? n_ : 0, context_.arena);
  if (about) place_about(lanes);
  bool aimed_anew = false;
  for (int k = 0; k < n_; ++k) aimed_anew |= look_at_light(k, lanes);
  if (aimed_anew) lanes.measure(ray_);
  weigh(lanes);
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
