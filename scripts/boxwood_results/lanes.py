"""Whom a ray contender is held against: peers with single rays or packets, watertight ones by themselves."""

RAYS = ("rays_closest", "rays_any", "rays_all")
PACKETS = ("sect8", "sect16", "occluded8", "occluded16")
SINGLE_LANE, BATCH_LANE, PACKET_LANE = "against single rays", "batches against single rays", "against packets"
WATERTIGHT = ", watertight"
EVERY = ""  # the one lane of all other tasks


def lanes_of(cell):
    """As in `boxwood show`. Ours tasks one ray in a call, or all in one: as a batch it is held against single rays
    and packets, sorted against packets alone, and of any kernel against peers that are not watertight."""
    if cell.job.task not in RAYS:
        return [EVERY]
    if not cell.ours:
        packets = any(part in cell.contender for part in PACKETS)
        lanes = [PACKET_LANE] if packets else [SINGLE_LANE, BATCH_LANE]
        return [lane + WATERTIGHT for lane in lanes] if ".robust" in cell.contender else lanes
    lanes = {"single_rays": [SINGLE_LANE], "sorted_rays": [PACKET_LANE]}.get(cell.traversal, [PACKET_LANE, BATCH_LANE])
    return lanes + [lane + WATERTIGHT for lane in lanes] if cell.kernel == "watertight" else lanes


def split(cells):
    """{lane: cells} of one job, those lanes alone in which both ours and peers run; else one lane of all."""
    found = {}
    for cell in cells:
        for lane in lanes_of(cell):
            found.setdefault(lane, []).append(cell)
    both = {lane: of for lane, of in sorted(found.items()) if {c.ours for c in of} == {True, False}}
    return both or {EVERY: cells}
