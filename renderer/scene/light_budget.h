// How many light samples are worth a march.
#pragma once

#include "renderer/scene/scene.h"

namespace brume {

/// Light samples of each light for which the cost of lighting and that of the march of the ray that they are drawn on
/// balance: with fewer, rays are marched for too little; with more, the samples of one ray tell the same again and
/// again. Between a half and double of it the error after a given time changes little. From what look-ups cost and how
/// long rays are on average; the same for every camera.
int balanced_light_samples(const Scene& scene);

}  // namespace brume
