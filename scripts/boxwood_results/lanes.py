"""Whom a ray contender is held against: peers with single rays or packets, watertight ones by themselves."""

RAYS = ("rays_closest", "rays_any", "rays_all")
PACKETS = ("sect8", "sect16", "occluded8", "occluded16")
EVERY = ""  # the one lane of all other asks


def lanes_of(cell):
    """As in `boxwood show`. Ours takes all rays in one call: in the order given it answers for single rays and
    packets, sorted for packets alone, and of any kernel for peers that are not watertight."""
    if cell.job.ask not in RAYS:
        return [EVERY]
    if not cell.ours:
        packets = any(part in cell.contender for part in PACKETS)
        return [("against packets" if packets else "against single rays")
                + (", watertight" if ".robust" in cell.contender else "")]
    lanes = ["against packets"]
    if cell.traversal != "sorted_rays":
        lanes.append("against single rays")
    if cell.kernel == "watertight":
        lanes += [f"{lane}, watertight" for lane in lanes]
    return lanes


def split(cells):
    """{lane: cells} of one job, those lanes alone in which both ours and peers run; else one lane of all."""
    found = {}
    for cell in cells:
        for lane in lanes_of(cell):
            found.setdefault(lane, []).append(cell)
    both = {lane: of for lane, of in sorted(found.items()) if {c.ours for c in of} == {True, False}}
    return both or {EVERY: cells}
