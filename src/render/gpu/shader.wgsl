// MuJoCo's classic look: light at the vertices, clamped there, times texture. Pictures are drawn upside down, so that
// samples lie where OpenGL has them.

struct Lamp {
    ambient: vec4f,
    diffuse: vec4f,
    specular: vec4f,     // w: cosine of the cutoff
    attenuation: vec4f,  // w: exponent of the spot
}

struct Scene {
    lamps: array<Lamp, 8>,
    // x: number of lamps, y: light without any lamp
    params: vec4f,
}

@group(0) @binding(0) var<uniform> scene: Scene;
// see `frame.rs`: a row of texels per view
@group(0) @binding(1) var views: texture_2d<f32>;
@group(1) @binding(0) var filtered: sampler;
@group(1) @binding(1) var image: texture_2d<f32>;
@group(1) @binding(1) var cube: texture_cube<f32>;

const VIEW_ROWS: u32 = 1024u;
const VIEW_TEXELS: u32 = 23u;
const EYE: u32 = 0u;
const FORWARD: u32 = 1u;
const RIGHT: u32 = 2u;
const UP: u32 = 3u;
const TILE: u32 = 4u;
const HALF: u32 = 5u;
const LENS: u32 = 6u;
const LAMPS: u32 = 7u;

struct Vertex {
    @location(0) place: vec4f,    // w: 0 body, 1 upper cap, 2 lower cap
    @location(1) normal: vec4f,
    @location(2) row_x: vec4f,    // from the unit shape to the camera
    @location(3) row_y: vec4f,
    @location(4) row_z: vec4f,
    @location(5) size: vec4f,     // w: index of the view
    @location(6) cap: vec4f,      // caps of capsules; w: 1 if the viewport is the picture, 0 if it is the texture
    @location(7) rgba: vec4f,
    @location(8) surface: vec4f,  // emission, specular, exponent, offset of texture coordinates
    @location(9) texture: vec4f,  // scale of texture coordinates; w: what segmentation shows
    @location(10) pose_x: vec4f,  // from the geom to the world
    @location(11) pose_y: vec4f,
    @location(12) pose_z: vec4f,
    @location(13) mapped: vec4f,  // texture coordinates; z: 1 if they count, 0 if they follow from the place
}

struct Seen {
    @builtin(position) clip: vec4f,
    @location(0) colour: vec4f,
    @location(1) coordinates: vec3f,
    @location(2) @interpolate(flat) id: f32,
}

fn view_texel(view: u32, k: u32) -> vec4f {
    return textureLoad(views, vec2u(k + VIEW_TEXELS * (view / VIEW_ROWS), view % VIEW_ROWS), 0);
}

// A row of the projection for a part of the shape: caps are not stretched with the length of a capsule.
fn part_row(row: vec4f, part: f32, cap: vec4f) -> vec4f {
    if part == 0.0 {
        return row;
    }
    let z = row.z * cap.x;
    var constant = z * cap.y + row.w;
    if part == 2.0 {
        constant = z * cap.z + constant;
    }
    return vec4f(row.xy, z, constant);
}

fn along(row: vec4f, p: vec3f) -> f32 {
    return p.x * row.x + p.y * row.y + p.z * row.z + row.w;
}

// Moves a place of the picture to where the picture lies in the texture. It is rounded to 1/256 pixels before, as it would
// be in the corner of the texture.
fn locate(place: vec2f, w: f32, tile: vec4f, half_size: vec4f) -> vec2f {
    let inverse = 1.0 / w;
    let pixels = (place * inverse) * half_size.xy + half_size.xy;
    if w >= half_size.z && all(abs(pixels) < vec2f(8192.0)) {
        return ((round(pixels * 256.0) * 0.00390625) * tile.xy + tile.zw) * w;
    }
    return (place * half_size.xy + half_size.xy * w) * tile.xy + tile.zw * w;
}

fn power(x: f32, y: f32) -> f32 {
    if x > 0.0 {
        return pow(x, y);
    }
    return select(0.0, 1.0, y == 0.0);
}

fn light(view: u32, p: vec3f, n: vec3f, own: vec3f, surface: vec4f) -> vec3f {
    let to_eye = normalize(view_texel(view, EYE).xyz - p);
    var colour = (surface.x + scene.params.y) * own;
    let count = u32(scene.params.x);
    for (var i = 0u; i < count; i++) {
        let lamp = scene.lamps[i];
        let place = view_texel(view, LAMPS + 2u * i);
        let direction = view_texel(view, LAMPS + 2u * i + 1u).xyz;
        var to_lamp = -direction;
        var strength = 1.0;
        if place.w != 0.0 {
            let d = place.xyz - p;
            let distance = length(d);
            to_lamp = d / distance;
            let a = lamp.attenuation;
            strength = 1.0 / (a.x + a.y * distance + a.z * distance * distance);
            if lamp.specular.w > -1.0 {
                let aligned = -dot(to_lamp, direction);
                strength *= select(power(aligned, a.w), 0.0, aligned < lamp.specular.w);
            }
        }
        let facing = dot(n, to_lamp);
        colour += strength * (lamp.ambient.rgb + max(facing, 0.0) * lamp.diffuse.rgb) * own;
        if facing > 0.0 {
            let middle = normalize(to_lamp + to_eye);
            colour += strength * surface.y * power(dot(n, middle), surface.z) * lamp.specular.rgb;
        }
    }
    return clamp(colour, vec3f(0.0), vec3f(1.0));
}

fn project(v: Vertex) -> vec4f {
    let part = v.place.w;
    let p = v.place.xyz;
    let view = u32(v.size.w);
    let lens = view_texel(view, LENS);
    let half_size = view_texel(view, HALF);
    let row_z = part_row(v.row_z, part, v.cap);
    let w = along(-row_z, p);
    var depth = lens.z * row_z;
    depth.w += lens.w;
    let z = along(depth, p);
    let place = vec2f(
        along(lens.x * part_row(v.row_x, part, v.cap), p),
        along(lens.y * part_row(v.row_y, part, v.cap), p),
    );
    if v.cap.w == 0.0 {
        return vec4f(locate(place, w, view_texel(view, TILE), half_size), z, w);
    }
    if half_size.w == 0.0 {
        return vec4f(place.x, -place.y, z, w);
    }
    let tile = vec4f(1.0, -1.0, -half_size.x, half_size.y) / half_size.xyxy;
    return vec4f(locate(place, w, tile, half_size), z, w);
}

@vertex
fn shape(v: Vertex) -> Seen {
    var seen: Seen;
    seen.clip = project(v);
    let part = v.place.w;
    let radius = 0.5 * (v.size.x + v.size.y);
    var size = v.size.xyz;
    var shift = 0.0;
    if part != 0.0 {
        shift = select(radius - size.z, size.z - radius, part == 1.0);
        size.z = radius;
    }
    let local = v.place.xyz * size + vec3f(0.0, 0.0, shift);
    let normal = v.normal.xyz / size;
    let p = vec3f(dot(v.pose_x.xyz, local), dot(v.pose_y.xyz, local), dot(v.pose_z.xyz, local));
    let n = normalize(vec3f(dot(v.pose_x.xyz, normal), dot(v.pose_y.xyz, normal), dot(v.pose_z.xyz, normal)));
    let origin = vec3f(v.pose_x.w, v.pose_y.w, v.pose_z.w);
    seen.colour = vec4f(light(u32(v.size.w), p + origin, n, v.rgba.rgb, v.surface), v.rgba.a);
    seen.coordinates = mix(v.place.xyz * v.texture.xyz + v.surface.w, vec3f(v.mapped.xy, 0.0), v.mapped.z);
    seen.id = v.texture.w;
    return seen;
}

@fragment
fn plain(seen: Seen) -> @location(0) vec4f {
    return seen.colour;
}

@fragment
fn with_image(seen: Seen) -> @location(0) vec4f {
    return vec4f(seen.colour.rgb * textureSample(image, filtered, seen.coordinates.xy).rgb, seen.colour.a);
}

@fragment
fn with_cube(seen: Seen) -> @location(0) vec4f {
    return vec4f(seen.colour.rgb * textureSample(cube, filtered, seen.coordinates).rgb, seen.colour.a);
}

struct Measured {
    @builtin(position) clip: vec4f,
    @location(0) @interpolate(flat) id: f32,
}

@vertex
fn measured_shape(v: Vertex) -> Measured {
    return Measured(project(v), v.texture.w);
}

// 1/distance from the plane of the camera, and what is seen.
@fragment
fn measure(seen: Measured) -> @location(0) vec2u {
    return vec2u(bitcast<u32>(seen.clip.w), u32(seen.id));
}

struct Sky {
    @builtin(position) clip: vec4f,
    @location(0) direction: vec3f,
}

// The whole picture, at the farthest depth.
@vertex
fn background(@builtin(vertex_index) k: u32, @location(0) view: f32) -> Sky {
    let v = u32(view);
    let corner = vec2f(f32(k & 1u), f32((k >> 1u) & 1u)) * 2.0 - 1.0;
    let half_size = view_texel(v, HALF).xy;
    let tile = view_texel(v, TILE);
    let pixels = corner * half_size + half_size;
    let d = view_texel(v, FORWARD).xyz + view_texel(v, RIGHT).xyz * corner.x + view_texel(v, UP).xyz * corner.y;
    return Sky(vec4f(pixels * tile.xy + tile.zw, 0.0, 1.0), vec3f(d.x, d.z, -d.y));
}

@fragment
fn sky(seen: Sky) -> @location(0) vec4f {
    return vec4f(textureSample(cube, filtered, seen.direction).rgb, 1.0);
}
