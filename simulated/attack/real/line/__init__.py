"""Lines between hosts and devices: listened to, slow, taken by another; and one beside them."""
