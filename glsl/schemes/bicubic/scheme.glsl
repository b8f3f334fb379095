// Regular patches.
