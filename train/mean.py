# SPDX-License-Identifier: Apache-2.0
"""The method `taau` (src/zoneplate/upscale/taau/sample_mean.cpp) at scale 2, in PyTorch, with the outputs of a network.

Frames are tensors (batch, channels, height, width). What no history is needed for is computed once per sequence
(`survey`, `came_from`); a step of the recurrence is `gather`, `features`, and `resolve`, through which gradients pass.

Pixels of the output are arranged by the frame's pixel whose sample is nearest to them: four for each, in reading order.
Their place in the output differs by `shift`, which depends on the jitter."""
import torch
import torch.nn.functional as F

LIKENESS, FADING, TREND_SHARE, UNREST_SHARE = 1 / 16, 1 / 8, 1 / 4, 1 / 4
MOST, MOST_FILTERED, MOST_BORROWED = 64.0, 3.0, 3 * 1.372 / 4
FEATURES, OUTPUTS = 40, 14
COUNT_AT_REST = 4.0


def luminance(color):
    return 0.2126 * color[:, :1] + 0.7152 * color[:, 1:2] + 0.0722 * color[:, 2:3]


def tone(x):
    """Light in [0, 1), about as bright as it is seen."""
    return (x / (1 + x)).sqrt()


def around(x):
    """The 3 x 3 pixels around each: (batch, channels, 9, height, width)."""
    b, c, h, w = x.shape
    return F.unfold(F.pad(x, (1, 1, 1, 1), mode="replicate"), 3).view(b, c, 9, h, w)


def pixel_grid(h, w, device):
    """The columns and rows of all pixels, as they broadcast with planes (batch, h, w)."""
    return (torch.arange(w, dtype=torch.float32, device=device).view(1, 1, w),
            torch.arange(h, dtype=torch.float32, device=device).view(1, h, 1))


def at_pixels(plane, x, y):
    """Values at whole pixels, beyond the frame the outermost ones."""
    b, c, h, w = plane.shape
    index = (y.clamp(0, h - 1) * w + x.clamp(0, w - 1)).long().view(b, 1, h * w)
    return plane.reshape(b, c, h * w).gather(2, index.expand(b, c, h * w)).view(b, c, h, w)


def survey(color, nearness, motion):
    """SampleMeanKernels::survey, and the farthest of the 3 x 3 surfaces."""
    colors, near, move = around(color), around(nearness)[:, 0], around(motion)
    order = near.clone()
    order[:, 4] += 1e-9 * order[:, 4].abs()
    nearest = order.argmax(1, keepdim=True)
    follow = torch.cat([move[:, k].gather(1, nearest) for k in (0, 1)], 1)
    spread = (move - follow.unsqueeze(2)).abs().amax((1, 2), keepdim=True)[:, 0]
    return {"low": colors.amin(2), "high": colors.amax(2), "follow": follow,
            "nearest": near.amax(1, keepdim=True), "farthest": near.amin(1, keepdim=True),
            "alike": (spread <= LIKENESS).float(),
            "borrowed": ((follow - motion).abs().amax(1, keepdim=True) > LIKENESS).float()}


def origin(motion):
    h, w = motion.shape[2:]
    x, y = pixel_grid(h, w, motion.device)
    return torch.floor(x - motion[:, 0] + 0.5), torch.floor(y - motion[:, 1] + 0.5)


def came_from(now, nearness, motion, last_alike, sample):
    """is_uncovered and is_steady of SampleMeanKernels::compare, but for what depends on the history's colours, of
    frames whose samples are at `sample` in their pixels."""
    b, _, h, w = motion.shape
    from_x, from_y = origin(motion)
    inside = (from_x >= 0) & (from_y >= 0) & (from_x < w) & (from_y < h)
    index = torch.where(inside, from_y * w + from_x, torch.full_like(from_x, h * w)).long().view(b, -1)
    sides = []
    for k, reduction, empty in ((0, "amin", 1e30), (0, "amax", -1e30), (1, "amin", 1e30), (1, "amax", -1e30)):
        plane = torch.full((b, h * w + 1), empty, device=motion.device)
        plane.scatter_reduce_(1, index, motion[:, k].reshape(b, -1), reduction)
        sides.append(plane[:, :-1].view(b, 1, h, w))
    nearest = torch.full((b, h * w + 1), -1e30, device=motion.device)
    nearest = nearest.scatter_reduce_(1, index, nearness.reshape(b, -1), "amax")[:, :-1].view(b, 1, h, w)

    x, y = origin(now["follow"])
    inside = ((x >= 0) & (y >= 0) & (x < w) & (y < h)).unsqueeze(1)
    follow_x, follow_y = now["follow"][:, :1], now["follow"][:, 1:]

    def came_alike(dx, dy):
        left, right, top, bottom = (at_pixels(s, x + dx, y + dy) for s in sides)
        return ((follow_x - left <= LIKENESS) & (right - follow_x <= LIKENESS) & (follow_y - top <= LIKENESS) &
                (bottom - follow_y <= LIKENESS))

    covered = at_pixels(nearest, x, y) > now["nearest"]
    uncovered = inside & covered & ~came_alike(0, 0)
    column, row = pixel_grid(h, w, motion.device)
    sample = sample.view(-1, 2, 1, 1)
    place_x = torch.floor((column + sample[:, 0] - now["follow"][:, 0]) * 2)
    place_y = torch.floor((row + sample[:, 1] - now["follow"][:, 1]) * 2)
    steady = inside & ((place_x >= 0) & (place_y >= 0) & (place_x < 2 * w) & (place_y < 2 * h)).unsqueeze(1)
    steady = steady & (now["alike"] > 0) & (at_pixels(last_alike, x, y) > 0)
    for dy in (-1, 0, 1):
        for dx in (-1, 0, 1):
            steady = steady & came_alike(dx, dy)
    return uncovered.float(), steady.float()


def restarts_of(change):
    """Where the light has changed at once: 7 x 7 windows with 40 more changes of one sign than of the other."""
    b, _, h, w = change.shape
    sums = F.avg_pool2d(F.pad(change, (3, 3, 3, 3), mode="replicate"), 7, 1) * 49
    windows = (sums.abs() > 39.5).float()
    return F.max_pool2d(windows, 11, 1, 5)


def compare(frame, state):
    """What depends on the history: changes, trends, the part of the history that counts, and the widened boxes."""
    color, steady = frame["color"], frame["steady"]
    h, w = color.shape[2:]
    x, y = origin(frame["follow"])
    low, high = at_pixels(state["low"], x, y), at_pixels(state["high"], x, y)
    slack = 0.05 * (low + high) + 0.002
    above = (color > high + slack).any(1, keepdim=True)
    below = (color < low - slack).any(1, keepdim=True)
    change = torch.where(above, torch.ones_like(steady), -below.float()) * steady
    # The history's pixel where the sample was.
    column, row = pixel_grid(h, w, color.device)
    sample = frame["sample"].view(-1, 2, 1, 1)
    px = torch.floor((column + sample[:, 0] - frame["follow"][:, 0]) * 2).clamp(0, 2 * w - 1)
    py = torch.floor((row + sample[:, 1] - frame["follow"][:, 1]) * 2).clamp(0, 2 * h - 1)
    old = luminance(state["history"]).reshape(-1, 1, 4 * h * w)
    before = old.gather(2, (py * 2 * w + px).long().view(-1, 1, h * w)).view(-1, 1, h, w)
    difference = luminance(color) - before
    sign = torch.sign(difference) * (difference.abs() > 0.005 * before + 0.0003)
    trend = at_pixels(state["trend"], x, y)
    trend = (trend + (sign - trend) * TREND_SHARE) * steady
    restarts = restarts_of(change)
    drift = F.avg_pool2d(F.pad(trend, (2, 2, 2, 2), mode="replicate"), 5, 1).abs()
    lost = ((drift - 0.5) / 0.3).clamp(0, 1)
    lost = torch.where((restarts > 0) | (frame["uncovered"] > 0), torch.ones_like(lost), lost)
    faded = lost.clamp(min=FADING)
    wide_low = torch.minimum(frame["low"], low + (frame["low"] - low) * faded)
    wide_high = torch.maximum(frame["high"], high + (frame["high"] - high) * faded)
    is_steady = steady > 0
    return {"low": torch.where(is_steady, wide_low, frame["low"]),
            "high": torch.where(is_steady, wide_high, frame["high"]), "kept": 1 - lost, "change": change,
            "trend": trend * (restarts == 0)}


def catmull_rom(history, x, y):
    """At the positions (x, y) of pixel centres: 4 x 4 pixels without the corners, by five bilinear fetches."""
    h, w = history.shape[2:]
    fx, fy = x - torch.floor(x), y - torch.floor(y)
    ix, iy = torch.floor(x), torch.floor(y)

    def weights(f):
        return (f * (f * (1 - 0.5 * f) - 0.5), 1 + f * f * (1.5 * f - 2.5), f * (0.5 + f * (2 - 1.5 * f)),
                f * f * (0.5 * f - 0.5))

    wx, wy = weights(fx), weights(fy)
    mx, my = wx[1] + wx[2], wy[1] + wy[2]
    cx, cy = ix + wx[2] / mx, iy + wy[2] / my

    def fetch(u, v):
        grid = torch.stack(((2 * u + 1) / w - 1, (2 * v + 1) / h - 1), -1)
        return F.grid_sample(history, grid, mode="bilinear", padding_mode="border", align_corners=False)

    taps = ((cx, cy, mx * my), (ix - 1, cy, wx[0] * my), (ix + 2, cy, wx[3] * my), (cx, iy - 1, mx * wy[0]),
            (cx, iy + 2, mx * wy[3]))
    total = sum(t[2] for t in taps)
    return (sum(fetch(u, v) * t.unsqueeze(1) for u, v, t in taps) / total.unsqueeze(1)).clamp(0, 65504)


def by_quarter(x):
    """(batch, channels, 2h, 2w), arranged by frame pixels, to (batch, channels, 4, h, w)."""
    b, c, h, w = x.shape
    return F.pixel_unshuffle(x, 2).view(b, c, 4, h // 2, w // 2)


def by_pixel(x):
    """The reverse of by_quarter."""
    b, c, _, h, w = x.shape
    return F.pixel_shuffle(x.reshape(b, 4 * c, h, w), 2)


def gather(frame, state):
    """The frame's samples and the history for each output pixel, arranged by frame pixels."""
    color = frame["color"]
    b, _, h, w = color.shape
    out = {"samples": around(color)}
    # Offsets of the four output pixels' centres from the nearest sample, in frame pixels.
    place = 0.25 - (frame["sample"] - 0.5)  # of output pixel 0
    shift = torch.floor(2 * place)
    first = place - shift / 2 - 0.5
    weights = []
    for k in range(9):
        row = []
        for s in range(4):
            dx = (k % 3 - 1) - (first[:, 0] + 0.5 * (s % 2))
            dy = (k // 3 - 1) - (first[:, 1] + 0.5 * (s // 2))
            row.append(torch.exp(-2.29 * 4 * (dx * dx + dy * dy)))
        weights.append(torch.stack(row, 1))
    out["shift"], out["first"] = shift, first
    out["weights"] = torch.stack(weights, 2)[..., None, None].expand(b, 4, 9, h, w)
    out["near"] = history_at(frame["follow"], state, shift)
    out["own"] = history_at(frame["motion"], state, shift)
    return out


def history_at(motion, state, shift):
    """The history that a motion of the frame's pixels comes from: its colours, counts, and whether it is in the image."""
    b, _, h, w = motion.shape
    motion = torch.floor(motion * 2 * 1024 + 0.5) / 1024
    wide = motion.repeat_interleave(2, 2).repeat_interleave(2, 3)
    x, y = pixel_grid(2 * h, 2 * w, motion.device)
    x, y = x - shift[:, 0].view(b, 1, 1), y - shift[:, 1].view(b, 1, 1)
    x, y = x - wide[:, 0], y - wide[:, 1]
    inside = (x >= -0.5) & (y >= -0.5) & (x <= 2 * w - 0.5) & (y <= 2 * h - 0.5)
    grid = torch.stack(((2 * x + 1) / (2 * w) - 1, (2 * y + 1) / (2 * h) - 1), -1)
    count = F.grid_sample(state["count"], grid, mode="bilinear", padding_mode="border", align_corners=False)
    return {"color": by_quarter(catmull_rom(state["history"], x, y)), "inside": by_quarter(inside.unsqueeze(1).float()),
            "count": by_quarter(count), "fraction": -motion - torch.floor(-motion)}


def mean_of(samples, weights):
    """The mean of 3 x 3 samples for each output pixel, and the sum of the weights."""
    total = weights.sum(2)
    middle = samples[:, :, 4:5]
    sums = sum(weights[:, :, k].unsqueeze(1) * (samples[:, :, k:k + 1] - middle) for k in range(9) if k != 4)
    return middle + sums / total.clamp(min=1e-4).unsqueeze(1), total


def features(frame, now, got, last_unrest):
    """The planes that the network reads, in [0, 1]; and the mean over few frames of |history - samples|."""
    b, _, h, w = frame["color"].shape
    low, high = now["low"].unsqueeze(2), now["high"].unsqueeze(2)
    near, own = got["near"], got["own"]
    borrowed = frame["borrowed"].unsqueeze(2) > 0

    def lights(colors):
        return tone(luminance(colors.flatten(2, 3))).view(b, 4, h, w)

    current = lights(mean_of(got["samples"], got["weights"])[0])
    past, history = lights(near["color"]), near["color"]
    second = lights(torch.where(borrowed, own["color"], history))
    second_count = torch.where(borrowed, own["count"] * own["inside"], near["count"]).mean(2) * now["kept"]
    limited = torch.minimum(torch.maximum(history, low), high)
    beyond = (history - limited).abs().sum(1) / (0.02 + limited.sum(1))
    light = tone(luminance(frame["color"]))
    apart = (frame["nearest"] - frame["farthest"]) / frame["nearest"].clamp(min=1e-20)
    fraction = 4 * near["fraction"] * (1 - near["fraction"])
    jitter = (got["first"] * 2 + 1).view(b, 2, 1, 1).expand(b, 2, h, w)
    count = near["count"].mean(2) * now["kept"]
    x, y = origin(frame["follow"])
    before = at_pixels(last_unrest, x, y)
    unrest = (past - current).abs().mean(1, keepdim=True)
    unrest = torch.where(count > 0, before + (unrest - before) * UNREST_SHARE, before)
    planes = [tone(frame["color"]), jitter, 2 * (light - tone(luminance(now["low"]))),
              2 * (tone(luminance(now["high"])) - light), frame["alike"], frame["borrowed"], frame["steady"],
              frame["uncovered"], now["kept"], 0.5 + 0.5 * now["change"], 0.5 + 0.5 * now["trend"],
              0.25 * frame["follow"].abs().sum(1, keepdim=True), fraction,
              (frame["nearest"] - frame["nearness"]) / (frame["nearest"] - frame["farthest"]).clamp(min=1e-20),
              apart / (0.02 + apart), 0.5 + 1.5 * (past - current), 0.5 + 1.5 * (past - past.mean(1, keepdim=True)),
              beyond / (1 + beyond), count / (COUNT_AT_REST + count),
              (tone(history) - tone(got["samples"][:, :, 4:5])).abs().mean((1, 2)).unsqueeze(1),
              near["inside"].mean(2), 0.5 + 1.5 * (second - current), second_count / (COUNT_AT_REST + second_count),
              4 * unrest]
    return torch.cat(planes, 1).clamp(0, 1), unrest


class InwardClamp(torch.autograd.Function):
    """Clamps; gradients that lead back inside pass, so that a bound can be left again."""

    @staticmethod
    def forward(context, x, low, high):
        context.save_for_backward(x)
        context.bounds = low, high
        return x.clamp(low, high)

    @staticmethod
    def backward(context, gradient):
        x, = context.saved_tensors
        low, high = context.bounds
        stuck = ((x < low) & (gradient > 0)) | ((x > high) & (gradient < 0))
        return gradient.masked_fill(stuck, 0), None, None


def resolve(frame, now, got, output):
    """One step of the mean: output (batch, 4, 14, h, w) are corrections of nine weights, of the history's validity, of
    the part of it that counts though `taau` lets it go, of the clamp, of the share of the history that the pixel's own
    surface had, and of the count of the frame's samples. Weights change the mean of these alone, so that a wide one
    does not count more; they change the less, the more samples the history has. Zeros: `taau`. Returns the image and
    the next history."""
    clamp = InwardClamp.apply
    kept = now["kept"]
    freedom = COUNT_AT_REST / (COUNT_AT_REST + got["near"]["count"][:, 0] * kept)
    weights = clamp(got["weights"] + (0.5 * freedom).unsqueeze(2) * output[:, :, :9], 0.0, 1e9)
    valid = clamp(1 + output[:, :, 9], 0.0, 1.0)
    kept_part = kept + (1 - kept) * clamp(output[:, :, 10], 0.0, 1.0)
    clamping = clamp(1 + output[:, :, 11], 0.0, 1.0)
    share = clamp(output[:, :, 12], 0.0, 1.0) * frame["borrowed"]
    current, _ = mean_of(got["samples"], weights)
    total = got["weights"].sum(2) * clamp(1 + output[:, :, 13], 0.1, 4.0)
    low, high = now["low"].unsqueeze(2), now["high"].unsqueeze(2)

    def limited(past, is_borrowed):
        moved = (torch.minimum(torch.maximum(past["color"], low), high) - past["color"]) * clamping.unsqueeze(1)
        color = past["color"] + moved
        beyond = moved.abs().sum(1) / (0.02 + color.abs().sum(1))
        filtered = (past["fraction"] > 0).any(1, keepdim=True)
        most = MOST + (MOST_FILTERED - MOST) * filtered.float()
        if is_borrowed:
            most = torch.where(frame["borrowed"] > 0, most.clamp(max=MOST_BORROWED), most)
        count = torch.minimum(past["count"][:, 0] * kept_part / (1 + beyond), most)
        return color, count * past["inside"][:, 0]

    near_color, near_count = limited(got["near"], True)
    own_color, own_count = limited(got["own"], False)
    past = near_color + (own_color - near_color) * share.unsqueeze(1)
    everything = (near_count + (own_count - near_count) * share) * valid + total
    mean = past + (current - past) * (total / everything.clamp(min=1e-4)).unsqueeze(1)
    image, everything = by_pixel(mean), by_pixel(everything.unsqueeze(1))
    b, _, h, w = image.shape
    column, row = pixel_grid(h, w, image.device)
    x = (column[0] + got["shift"][:, :1]).clamp(0, w - 1).long()
    y = (row[:, :, 0] + got["shift"][:, 1:]).clamp(0, h - 1).long()
    both = torch.cat([image, everything], 1)
    both = both.gather(2, y.view(b, 1, h, 1).expand(b, 4, h, w)).gather(3, x.view(b, 1, 1, w).expand(b, 4, h, w))
    image, everything = both[:, :3], both[:, 3:]
    return image, everything


def first_state(b, h, w, device):
    """What precedes the first of frames of this size: nothing has been seen."""
    zeros = lambda channels, scale: torch.zeros(b, channels, scale * h, scale * w, device=device)
    return {"history": zeros(3, 2), "count": zeros(1, 2), "low": zeros(3, 1), "high": zeros(3, 1), "trend": zeros(1, 1),
            "unrest": zeros(1, 1)}


def step(frame, state, is_first, network=None):
    """The image and the next state; without a network those of `taau`. `is_first` is a flag per sequence, whose state
    is that of first_state."""
    b, _, h, w = frame["color"].shape
    with torch.no_grad():
        past = {k: v.detach() for k, v in state.items()}
        first = is_first.view(b, 1, 1, 1)
        start = {"low": frame["low"], "high": frame["high"]}
        now = {k: torch.where(first, start.get(k, torch.zeros_like(v)), v) for k, v in compare(frame, past).items()}
    got = gather(frame, state)
    if network is None:
        output, unrest = torch.zeros(b, 4, OUTPUTS, h, w, device=first.device), past["unrest"]
    else:
        with torch.no_grad():
            planes, unrest = features(frame, now, got, past["unrest"])
            planes = torch.floor(planes * 127 + 0.5) / 127
        output = network(planes).view(b, 4, OUTPUTS, h, w)
    image, count = resolve(frame, now, got, output)
    return image, {"history": image, "count": count, "low": now["low"], "high": now["high"], "trend": now["trend"],
                   "unrest": unrest}
