// Sun, sky and a studio background; colours are linear until encodePicture, but for the background.
#ifndef TESSERA_LIB_LIGHTING
#define TESSERA_LIB_LIGHTING

const vec3 SUN_DIRECTION = vec3(0.4867, 0.6489, 0.5849);  // towards the sun, unit
const vec3 SUN_COLOR = vec3(5.2, 4.8, 4.2);
const vec3 SKY_COLOR = vec3(0.20, 0.26, 0.36);
const vec3 GROUND_COLOR = vec3(0.085, 0.07, 0.06);

struct SurfaceColor
{
	vec3 base;
	vec3 emissive;
	float metallic;
	float roughness;
};

// Trowbridge-Reitz distribution with Schlick's Fresnel and a matched visibility term (Karis 2013).
vec3 specular(SurfaceColor color, vec3 normal, vec3 to_eye, vec3 to_light)
{
	vec3 half_way = normalize(to_eye + to_light);
	float alpha = max(color.roughness * color.roughness, 0.02);
	float alpha_squared = alpha * alpha;
	float n_h = max(dot(normal, half_way), 0.0);
	float n_l = max(dot(normal, to_light), 1e-4);
	float n_v = max(dot(normal, to_eye), 1e-4);
	float spread = n_h * n_h * (alpha_squared - 1.0) + 1.0;
	float distribution = alpha_squared / (3.14159265 * spread * spread);
	float k = (color.roughness + 1.0) * (color.roughness + 1.0) / 8.0;
	float visibility = 0.25 / ((n_l * (1.0 - k) + k) * (n_v * (1.0 - k) + k));
	vec3 f0 = mix(vec3(0.04), color.base, color.metallic);
	vec3 fresnel = f0 + (1.0 - f0) * pow(1.0 - max(dot(half_way, to_eye), 0.0), 5.0);
	return distribution * visibility * fresnel;
}

vec3 skyLight(vec3 direction, float blur)
{
	return mix(GROUND_COLOR, SKY_COLOR, smoothstep(-blur, blur, direction.y));
}

// How much of the light reaches a surface, 0..1: of the sun, and of all around.
struct LightVisibility
{
	float sun;
	float ambient;
};

// Light that a surface sends to the eye; all directions in world space, unit.
vec3 litColor(SurfaceColor color, vec3 normal, vec3 to_eye, LightVisibility visibility)
{
	float n_l = max(dot(normal, SUN_DIRECTION), 0.0);
	vec3 diffuse = color.base * (1.0 - color.metallic);
	vec3 light = diffuse * (SUN_COLOR * (n_l * visibility.sun) / 3.14159265 + skyLight(normal, 1.0) * visibility.ambient);
	light += specular(color, normal, to_eye, SUN_DIRECTION) * SUN_COLOR * (n_l * visibility.sun);
	vec3 f0 = mix(vec3(0.04), color.base, color.metallic);
	light += f0 * skyLight(reflect(-to_eye, normal), mix(0.05, 1.0, color.roughness)) * visibility.ambient;
	return light + color.emissive;
}

// Packed RGBA8 behind everything: most of many pictures, so written as encoded colour, brighter below. `direction` need not be unit.
uint background(vec3 direction)
{
	float blend = smoothstep(-0.6, 0.6, direction.y * inversesqrt(dot(direction, direction)));
	vec3 encoded = vec3(0.268505, 0.289018, 0.333396) - blend * (vec3(0.158225, 0.158885, 0.156598) + blend * vec3(0.049431, 0.047251, 0.044105));
	return packUnorm4x8(vec4(encoded, 1.0));
}

// Narkowicz's fit of the ACES tone curve, then the sRGB transfer function; packed RGBA8.
uint encodePicture(vec3 linear_color, bool tone_map)
{
	vec3 c = max(linear_color, vec3(0.0));
	if (tone_map)
		c = clamp(c * (2.51 * c + 0.03) / (c * (2.43 * c + 0.59) + 0.14), 0.0, 1.0);
	vec3 srgb = mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
	return packUnorm4x8(vec4(clamp(srgb, 0.0, 1.0), 1.0));
}

#endif
