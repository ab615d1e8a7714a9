"""All that devices can do to a servo."""

from .device_causes import DEVICE_CAUSES
from .hidden_causes import HIDDEN_CAUSES
from .honest_hands import HONEST_HANDS
from .line_causes import LINE_CAUSES
from .slow_causes import SLOW_CAUSES

CAUSES = (*DEVICE_CAUSES, *LINE_CAUSES, *HIDDEN_CAUSES, *SLOW_CAUSES, *HONEST_HANDS)
HAPLY_CAUSES = tuple(cause for cause in CAUSES if cause.anywhere)
