// hidden.h: how far instances lie behind what hides them, kept from frame to frame: their segments grow by it where only rays of light meet them.
// Source: docs/raytracing.md, "Behind something".
#ifndef TESSERA_SHARED_HIDDEN_H
#define TESSERA_SHARED_HIDDEN_H
#include "shared/lang.h"

SHARED_BEGIN

// Of one instance. All 0: it is seen, or was not hidden for long.
struct HiddenInstance
{
	float distance_world;  // taken for how far it lies out of view, everywhere on it
	float margin;  // how far it would have to move on screen to be seen when that was last measured, in heights of the picture; 0: it may be seen
	uint frames;   // for how many frames in a row it has not been seen; saturates
};
SHARED_LAYOUT(HiddenInstance, 12, frames, 8)

// In heights of the picture: what is nearer than SAFE to being seen is as fine as in view; from there segments grow for RAMP. Farther is measured as
// that.
#define HIDDEN_SAFE 0.03125f
#define HIDDEN_RAMP 0.125f
#define HIDDEN_RAMP_INVERSE 8.0f
#define HIDDEN_FARTHEST (HIDDEN_SAFE + HIDDEN_RAMP)
// What may be seen is as fine as in view at once; what is hidden has to be so for some frames, and then grows by a share of the whole in each.
#define HIDDEN_WAIT_FRAMES 8u
#define HIDDEN_STEP 0.03125f

// What follows after a frame that found the instance `margin` from being seen (0 or less: it may be). `whole_world`: what counts as half a turn out
// of view.
SHARED_FN HiddenInstance nextHidden(HiddenInstance last, float margin, float whole_world)
{
	HiddenInstance next;
	next.margin = max(margin, 0.0f);
	next.frames = margin > 0.0f ? min(last.frames + 1u, HIDDEN_WAIT_FRAMES) : 0u;
	// Where it comes nearer as fast as in the last frame, it is fine again before it is seen.
	precise float nearer = last.margin - next.margin;
	precise float approach = last.frames > 0u ? max(nearer, 0.0f) : 0.0f;
	precise float before_safe = next.margin - 2.0f * approach;
	precise float beyond = before_safe - HIDDEN_SAFE;
	precise float share = min(max(beyond * HIDDEN_RAMP_INVERSE, 0.0f), 1.0f);
	precise float target = share * whole_world;
	precise float grown = last.distance_world + HIDDEN_STEP * whole_world;
	next.distance_world = min(target, next.frames < HIDDEN_WAIT_FRAMES ? last.distance_world : grown);
	return next;
}

SHARED_END

#endif
