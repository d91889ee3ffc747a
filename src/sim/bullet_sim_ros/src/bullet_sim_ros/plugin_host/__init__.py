"""What plugins are written against: context, tags, registry, and output that several share."""
