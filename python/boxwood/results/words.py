"""Numbers as the program writes them (bench/io/text_table.h), and the words that columns of few may hold
(results/words.h has the same)."""

PHASES = ("", "build", "cold_build", "update", "query", "cold_query", "upload", "device_build", "device_query", "download",
          "build+query", "update+query", "cold_build+query")
STATUSES = ("unchecked", "exact", "conservative", "within_bound", "unsupported", "wrong")
FAMILIES = ("", "peers", "ours", "threads", "stages", "devices", "errors")
TOPICS = ("", "race", "call", "kernel", "scene", "device")
VERDICTS = ("", "faster", "slower", "same", "cannot_tell", "wrong")
REASONS = ("", "too_few_rounds", "below_the_floor", "crosses_1", "unchecked", "too_noisy", "memory_layout")


def digits_text(value, most):
    """Three digits, at most so many of them behind the point."""
    digits = 0 if value >= 99.95 else 1 if value >= 9.995 else 2 if value >= 0.9995 or most == 2 else 3
    return f"{value:.{digits}f}"


def ratio_text(value):
    """Three digits: '0.412', '3.12', '120'."""
    return "-" if value != value else digits_text(value, 3)


def interval_text(mid, lo, hi):
    """A ratio with its interval, where it has one: '3.12x (2.98 to 3.20)'."""
    if mid != mid:
        return "-"
    return f"{ratio_text(mid)}x" + (f" ({ratio_text(lo)} to {ratio_text(hi)})" if lo == lo and hi == hi else "")


def time_text(ns):
    """Three digits with the unit that suits: '12.3 ms'."""
    if ns != ns:
        return "-"
    for unit, scale in (("ns", 1), ("us", 1e3), ("ms", 1e6), ("s", 1e9)):
        if ns < 999.5 * scale:
            break
    return f"{digits_text(ns / scale, 2)} {unit}"


def time_tick(ns):
    """Of an axis, whose numbers are round: '12 ms'."""
    number, unit = time_text(ns).split()
    return f"{float(number):g} {unit}"


def count_text(value):
    """'10k' of 10,000, '1.5M' of 1,500,000."""
    for scale, unit in ((1e9, "G"), (1e6, "M"), (1e3, "k")):
        if value >= scale:
            return f"{value / scale:g}{unit}"
    return f"{value:g}"
