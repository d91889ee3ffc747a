"""What all camera plugins share: tags, topics, encodings, CameraInfo."""
