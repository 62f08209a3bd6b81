// The visibility image as a buffer: per pixel depth << 32 | payload. 0 is background, nearer is larger.
#ifndef TESSERA_LIB_VISIBILITY_BUFFER
#define TESSERA_LIB_VISIBILITY_BUFFER

layout(buffer_reference, scalar, buffer_reference_align = 16) buffer VisibilityRef { uint64_t at[]; };

#endif
