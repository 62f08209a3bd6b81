// What rays are traced through, and what a primary ray brings back.
#ifndef TESSERA_LIB_TRACED_SCENE
#define TESSERA_LIB_TRACED_SCENE

struct TracedHit
{
	float along;   // the ray's parameter there; 0: nothing was met
	uint payload;  // of the visibility image
};

// Farther than anything: distances are scaled so that the scene ends between 1 and 2 (shared/view.h), unless it is seen from far away.
const float RAY_END = 1e30;

// Of shadow and ambient rays: any surface is in the way, whatever side it shows.
const uint LIGHT_RAY_FLAGS = gl_RayFlagsOpaqueEXT | gl_RayFlagsTerminateOnFirstHitEXT | gl_RayFlagsSkipClosestHitShaderEXT;

#endif
