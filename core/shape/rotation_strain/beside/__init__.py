"""A body at rest beside tools, which it is kept out of and held by."""
