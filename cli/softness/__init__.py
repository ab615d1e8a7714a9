"""palpate shore, materials, durometer, curve and softness."""
